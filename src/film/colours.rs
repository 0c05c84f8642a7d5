//! One palette for all pictures of a loop: 256 colours a GIF can show, the same in every picture, so that nothing at rest changes its colour.
//!
//! Colours are counted over some of the pictures and the box that holds them is cut in two where its colours differ most, again and
//! again. A colour weighs as the square root of its pixels: a thin curve is told from the wide background it runs over.

use image::RgbaImage;
use std::collections::{BTreeMap, HashMap, HashSet};

/// Colours of a GIF.
const MOST: usize = 256;
/// Pictures that are counted at most.
const COUNTED: usize = 12;
/// Levels of a channel that are counted as one.
const LEVELS: u8 = 4;

type Rgb = [u8; 3];

/// The pictures in at most 256 colours all together, among them all of `kept`; as they are where they have no more.
#[must_use]
pub fn reduced(pictures: &[RgbaImage], kept: &[Rgb]) -> Vec<RgbaImage> {
    if !has_more_than(MOST, pictures) {
        return pictures.to_vec();
    }
    let palette = palette(pictures, kept);
    let mut known: HashMap<Rgb, Rgb> = HashMap::new();
    let mut picture = |picture: &RgbaImage| {
        let mut picture = picture.clone();
        for pixel in picture.pixels_mut() {
            let [r, g, b, alpha] = pixel.0;
            let [r, g, b] = *known.entry([r, g, b]).or_insert_with(|| nearest(&palette, [r, g, b]));
            pixel.0 = [r, g, b, alpha];
        }
        picture
    };
    pictures.iter().map(&mut picture).collect()
}

fn has_more_than(most: usize, pictures: &[RgbaImage]) -> bool {
    let mut colours = HashSet::new();
    pictures.iter().flat_map(RgbaImage::pixels).any(|pixel| colours.insert(pixel.0) && colours.len() > most)
}

/// Square of the distance of two colours.
fn distance(a: Rgb, b: Rgb) -> i32 {
    (0..3).map(|i| (i32::from(a[i]) - i32::from(b[i])).pow(2)).sum()
}

/// The first of those that are nearest.
fn nearest(palette: &[Rgb], colour: Rgb) -> Rgb {
    palette.iter().copied().min_by_key(|entry| distance(*entry, colour)).unwrap_or(colour)
}

/// A colour that occurs, and what it weighs.
#[derive(Debug, Clone, Copy)]
struct Weighed {
    colour: [f64; 3],
    weight: f64,
}

fn palette(pictures: &[RgbaImage], kept: &[Rgb]) -> Vec<Rgb> {
    let mut boxes = vec![ColourBox::new(counted(pictures))];
    let wanted = MOST.saturating_sub(kept.len()).max(1);
    while boxes.len() < wanted {
        let spread = |n: &usize| boxes[*n].spread;
        let Some(widest) = (0..boxes.len()).max_by(|a, b| spread(a).total_cmp(&spread(b))) else { break };
        if boxes[widest].spread <= 0.0 {
            break;
        }
        let [low, high] = boxes.swap_remove(widest).halves();
        boxes.extend([low, high]);
    }
    let means = boxes.iter().map(|part| part.mean.map(|channel| channel.round() as u8));
    kept.iter().copied().chain(means).take(MOST).collect()
}

fn counted(pictures: &[RgbaImage]) -> Vec<Weighed> {
    let mut cells: BTreeMap<Rgb, ([f64; 3], f64)> = BTreeMap::new();
    for pixel in pictures.iter().step_by(pictures.len().div_ceil(COUNTED).max(1)).flat_map(RgbaImage::pixels) {
        let [r, g, b, _] = pixel.0;
        let (sum, count) = cells.entry([r, g, b].map(|channel| channel / LEVELS)).or_default();
        for (sum, channel) in sum.iter_mut().zip([r, g, b]) {
            *sum += f64::from(channel);
        }
        *count += 1.0;
    }
    let weighed = |(sum, count): ([f64; 3], f64)| Weighed { colour: sum.map(|sum| sum / count), weight: count.sqrt() };
    cells.into_values().map(weighed).collect()
}

/// Colours that become one.
#[derive(Debug)]
struct ColourBox {
    colours: Vec<Weighed>,
    mean: [f64; 3],
    /// The channel in which they differ most, and the sum of weighed squares by which they do; 0 for a single colour.
    channel: usize,
    spread: f64,
}

impl ColourBox {
    fn new(colours: Vec<Weighed>) -> Self {
        let whole: f64 = colours.iter().map(|c| c.weight).sum();
        let mean = [0, 1, 2].map(|i| colours.iter().map(|c| c.weight * c.colour[i]).sum::<f64>() / whole);
        let squares =
            [0, 1, 2].map(|i| colours.iter().map(|c| c.weight * (c.colour[i] - mean[i]).powi(2)).sum::<f64>());
        let channel = (0..3).max_by(|a, b| squares[*a].total_cmp(&squares[*b])).unwrap_or(0);
        let spread = if colours.len() > 1 { squares[channel] } else { 0.0 };
        Self { colours, mean, channel, spread }
    }

    /// Those below the mean and the others: neither is empty where they differ.
    fn halves(self) -> [Self; 2] {
        let (channel, mean) = (self.channel, self.mean[self.channel]);
        let (low, high) = self.colours.into_iter().partition(|c| c.colour[channel] < mean);
        [Self::new(low), Self::new(high)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    /// Colours of curves that cover one pixel in 2000 of a background that runs through more colours than a palette has.
    const CURVES: [Rgb; 3] = [[0x56, 0xb4, 0xe9], [0xf0, 0xe4, 0x42], [0xff, 0x7a, 0x1a]];

    fn pictures() -> Vec<RgbaImage> {
        let picture = |n: u32| {
            RgbaImage::from_fn(200, 100, |x, y| match (x * 100 + y) % 2003 {
                curve @ 0..3 => {
                    let [r, g, b] = CURVES[curve as usize];
                    Rgba([r, g, b, 255])
                }
                _ => Rgba([(x / 2) as u8, (y + 4 * n) as u8, ((x + y) / 3) as u8, 255]),
            })
        };
        (0..5).map(picture).collect()
    }

    fn colours(pictures: &[RgbaImage]) -> HashSet<[u8; 4]> {
        pictures.iter().flat_map(RgbaImage::pixels).map(|pixel| pixel.0).collect()
    }

    fn loss(pictures: &[RgbaImage], colour: Rgb) -> i32 {
        colours(pictures).into_iter().map(|[r, g, b, _]| distance([r, g, b], colour)).min().unwrap()
    }

    #[test]
    fn all_pictures_share_one_palette_that_has_the_kept_colours() {
        let (pictures, none) = (pictures(), reduced(&pictures(), &[]));
        let all = reduced(&pictures, &CURVES);
        assert!(colours(&pictures).len() > 2000);
        assert!(colours(&all).len() <= MOST && colours(&none).len() <= MOST);
        for colour in CURVES {
            assert_eq!(loss(&all, colour), 0);
            // Closer than 12, a difference that is hard to see, if only they are counted.
            assert!(loss(&none, colour) < 12 * 12, "{colour:?}: {}", loss(&none, colour));
        }
        // Negative control: a colour that does not occur.
        assert!(loss(&all, [0xb0, 0x43, 0x7f]) > 12 * 12);
        // Nor is any other colour further off than that; measured 8.
        let worst = |a: &RgbaImage, b: &RgbaImage| {
            let rgb = |p: &Rgba<u8>| [p.0[0], p.0[1], p.0[2]];
            a.pixels().zip(b.pixels()).map(|(a, b)| distance(rgb(a), rgb(b))).max().unwrap()
        };
        assert!(pictures.iter().zip(&all).all(|(a, b)| worst(a, b) < 12 * 12));
    }

    #[test]
    fn pictures_of_few_colours_are_left_alone() {
        let few = RgbaImage::from_fn(16, 16, |x, y| Rgba([(16 * y + x) as u8, 0, 0, 255]));
        assert_eq!(reduced(std::slice::from_ref(&few), &CURVES)[0], few);
    }
}
