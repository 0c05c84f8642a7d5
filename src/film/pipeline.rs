//! Draws on the calling thread; stores pictures on a second and encodes the film on a third, in the order of the frames.
//!
//! A stage that fails stops taking pictures; the stage before it then finds its queue closed and stops as well. The error is reported once,
//! by the stage that has it.

use super::FrameSource;
use super::error::FilmError;
use super::plan::{Finished, Plan, frame_name};
use super::report::{FilmReport, Progress, StageTimes};
use super::settings::FilmSettings;
use super::video::{Film, VideoEncoder};
use super::{manifest, picture};
use crate::render::{DrawList, Renderer, shrunk};
use crate::store::{OutputDir, read_whole};
use image::RgbaImage;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{self, ScopedJoinHandle};
use std::time::{Duration, Instant};

/// Pictures waiting between two stages.
const QUEUE: usize = 2;

/// A frame on its way; without picture if it is on disk already.
struct Job {
    index: u64,
    image: Option<RgbaImage>,
}

/// Draws, stores and films the frames of `source` into `output`, and reuses what is there already.
///
/// Files: `frames/NNNNNN.png`, `frames.json`, and a film as `settings.video` says.
///
/// # Errors
/// Any [`FilmError`]; frames finished by then are kept and reused by the next call. Nothing is drawn if a file of someone else is in the way.
pub fn produce(
    settings: &FilmSettings,
    output: &OutputDir,
    renderer: &mut dyn Renderer,
    source: &dyn FrameSource,
    progress: &mut dyn FnMut(Progress),
) -> Result<FilmReport, FilmError> {
    let start = Instant::now();
    let adapter = renderer.info().clone();
    let mut plan = Plan::new(settings, output, &adapter, source)?;
    output.refuse_foreign(&plan.file_names())?;
    let reused = plan.finished.range(plan.selected.clone()).count() as u64;
    let frames = plan.selected.end - plan.selected.start;

    let film_is_there = plan.nothing_to_draw()
        && plan
            .film
            .as_ref()
            .is_none_or(|film| output.trusted(&film.name, &film.key(settings, &plan.finished)).is_some());
    let mut times = StageTimes::default();
    if film_is_there {
        progress(Progress { done: frames, total: frames, drawn: 0, reused });
    } else {
        let (drawn, film, spent) = run_stages(settings, output, &plan, renderer, source, progress)?;
        plan.finished.extend(drawn);
        times = spent;
        if let (Some(film), Some(to_make)) = (film, &plan.film) {
            let begin = Instant::now();
            output.write(&to_make.name, &to_make.key(settings, &plan.finished), |writer| film.write(writer))?;
            times.encode_video += begin.elapsed();
        }
    }
    manifest::write(settings, output, &adapter, source, &plan)?;

    let film = plan.film.as_ref().map(|film| output.path().join(&film.name));
    let pictures = plan.selected.clone().map(|index| output.path().join(frame_name(index)));
    Ok(FilmReport {
        frames,
        drawn: frames - reused,
        reused,
        width: settings.size[0],
        height: settings.size[1],
        frames_per_second: settings.frames_per_second,
        files: film.iter().cloned().chain([output.path().join("frames.json")]).chain(pictures).collect(),
        film,
        times,
        wall: start.elapsed(),
    })
}

type Made = (Finished, Option<Film>, StageTimes);

fn run_stages(
    settings: &FilmSettings,
    output: &OutputDir,
    plan: &Plan,
    renderer: &mut dyn Renderer,
    source: &dyn FrameSource,
    progress: &mut dyn FnMut(Progress),
) -> Result<Made, FilmError> {
    thread::scope(|scope| {
        let (to_store, drawn) = sync_channel(QUEUE);
        let (to_video, stored) = sync_channel(QUEUE);
        let video = plan.film.as_ref().map(|_| scope.spawn(|| encode_video(settings, output, stored)));
        let to_video = video.is_some().then_some(to_video);
        let storing = scope.spawn(move || store_pictures(settings, output, plan, drawn, to_video));

        let drawing = draw_frames(settings, plan, renderer, source, to_store, progress);
        // All threads end before the first error is returned.
        let (stored, filmed) = (join(storing), video.map(join));
        let mut times = drawing?;
        let (finished, encode_png) = stored?;
        let (film, encode_video) = filmed.transpose()?.unzip();
        times.encode_png = encode_png;
        times.encode_video = encode_video.unwrap_or_default();
        Ok((finished, film, times))
    })
}

/// A panic of a stage goes on in the caller.
fn join<T>(handle: ScopedJoinHandle<'_, T>) -> T {
    handle.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

/// First stage: every frame of the film, or those selected where there is no film.
fn draw_frames(
    settings: &FilmSettings,
    plan: &Plan,
    renderer: &mut dyn Renderer,
    source: &dyn FrameSource,
    next: SyncSender<Job>,
    progress: &mut dyn FnMut(Progress),
) -> Result<StageTimes, FilmError> {
    let mut times = StageTimes::default();
    let frames = plan.film.as_ref().map_or(plan.selected.clone(), |film| film.frames.clone());
    let mut told = Progress { done: 0, total: plan.selected.end - plan.selected.start, drawn: 0, reused: 0 };
    for index in frames {
        let is_finished = plan.finished.contains_key(&index);
        let image = if is_finished { None } else { Some(draw(settings, renderer, source, index, &mut times)?) };
        if next.send(Job { index, image }).is_err() {
            break;
        }
        if plan.selected.contains(&index) {
            told.done += 1;
            *if is_finished { &mut told.reused } else { &mut told.drawn } += 1;
            progress(told);
        }
    }
    Ok(times)
}

fn draw(
    settings: &FilmSettings,
    renderer: &mut dyn Renderer,
    source: &dyn FrameSource,
    index: u64,
    times: &mut StageTimes,
) -> Result<RgbaImage, FilmError> {
    let begin = Instant::now();
    let list: DrawList = source.frame(index).map_err(|source| FilmError::Source { index, source })?;
    times.scene += begin.elapsed();
    let drawn_size = settings.drawn_size();
    check_drawn(drawn_size, index, list.size)?;
    let (image, spent) = renderer.draw(&list).map_err(|source| FilmError::Render { index, source })?;
    check_drawn(drawn_size, index, [image.width(), image.height()])?;
    let begin = Instant::now();
    let image = if settings.supersampling > 1 { shrunk(&image, settings.supersampling) } else { image };
    times.draw += begin.elapsed();
    times.draw += spent.draw;
    times.read_back += spent.read_back;
    times.overlay += spent.overlay;
    Ok(image)
}

fn check_size(settings: &FilmSettings, index: u64, found: [u32; 2]) -> Result<(), FilmError> {
    check_drawn(settings.size, index, found)
}

fn check_drawn(expected: [u32; 2], index: u64, found: [u32; 2]) -> Result<(), FilmError> {
    if found == expected {
        return Ok(());
    }
    let ([width, height], [found_width, found_height]) = (expected, found);
    Err(FilmError::FrameSize { index, width, height, found_width, found_height })
}

/// Second stage: PNG files of new frames, and pictures of old ones where a film needs them.
fn store_pictures(
    settings: &FilmSettings,
    output: &OutputDir,
    plan: &Plan,
    jobs: Receiver<Job>,
    next: Option<SyncSender<(u64, RgbaImage)>>,
) -> Result<(Finished, Duration), FilmError> {
    let mut finished = Finished::new();
    let mut spent = Duration::ZERO;
    for Job { index, image } in jobs {
        let begin = Instant::now();
        let image = match image {
            Some(image) => {
                finished.insert(index, store(output, plan, index, &image)?);
                Some(image)
            }
            None if next.is_some() => Some(load(settings, output, index)?),
            None => None,
        };
        spent += begin.elapsed();
        if let (Some(next), Some(image)) = (&next, image)
            && next.send((index, image)).is_err()
        {
            break;
        }
    }
    Ok((finished, spent))
}

fn store(output: &OutputDir, plan: &Plan, index: u64, image: &RgbaImage) -> Result<String, FilmError> {
    let failed = |error: png::EncodingError| FilmError::Encode { index, format: "PNG", reason: error.to_string() };
    let bytes = picture::encode(image).map_err(failed)?;
    Ok(output.write(&frame_name(index), &plan.frame_key, |writer| writer.write_all(&bytes))?.sha256)
}

fn load(settings: &FilmSettings, output: &OutputDir, index: u64) -> Result<RgbaImage, FilmError> {
    let path = output.path().join(frame_name(index));
    let image = picture::decode(&read_whole(&path)?).map_err(|reason| FilmError::FrameChanged { path, reason })?;
    check_size(settings, index, [image.width(), image.height()])?;
    Ok(image)
}

/// Third stage.
fn encode_video(
    settings: &FilmSettings,
    output: &OutputDir,
    pictures: Receiver<(u64, RgbaImage)>,
) -> Result<(Film, Duration), FilmError> {
    let mut encoder = VideoEncoder::new(settings, output)?;
    let mut spent = Duration::ZERO;
    for (index, image) in pictures {
        let begin = Instant::now();
        encoder.push(index, &image)?;
        spent += begin.elapsed();
    }
    let begin = Instant::now();
    let film = encoder.finish(settings)?;
    Ok((film, spent + begin.elapsed()))
}
