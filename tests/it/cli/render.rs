//! `render`: films of stored trajectories, single pictures, frames with alpha.

use super::{document, refused, scene_file, stickslip};
use std::fs;
use std::path::Path;

#[test]
fn a_film_of_a_trajectory_that_has_changed_is_not_taken_for_the_old_one() {
    let folder = tempfile::tempdir().unwrap();
    let (table, output) = (folder.path().join("t.csv"), folder.path().join("film"));
    let (table, output) = (table.to_str().unwrap(), output.to_str().unwrap());
    let render =
        ["render", "--trajectory", table, "--size", "64x64", "--fps", "2", "--renderer", "cpu", "-o", output, "--json"];
    document(&["simulate", "--t-end", "8", "-o", table, "--json"]);
    document(&render);
    document(&["simulate", "--t-end", "8", "--with", "rapier", "-o", table, "--force", "--json"]);
    refused(&render, &["other parameters", "--force"]);
    refused(&["render", "--trajectory", table, "--xi1", "-0.1"], &["--xi1"]);
    document(&["simulate", "--t-end", "8", "--sample", "2", "-o", table, "--force", "--json"]);
    refused(&render, &["too coarse"]);
}

#[test]
fn a_single_picture_is_drawn_at_any_time_of_the_motion() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("still.png");
    let path = path.to_str().unwrap();
    let still = [
        "render",
        "--with",
        "exact",
        "--at",
        "10.123",
        "--t-end",
        "12",
        "--size",
        "320x180",
        "--renderer",
        "cpu",
        "-o",
        path,
    ];
    document(&[&still[..], &["--json"]].concat());
    assert_eq!(image::open(path).unwrap().to_rgba8().dimensions(), (320, 180));
    refused(&still, &["exists", "--force"]);
    refused(&["render", "--at", "10", "-o", "still.jpg"], &[".png"]);
    for option in ["--encoder=openh264", "--frames=0:1"] {
        refused(&["render", "--at", "10", option, "-o", "still.png"], &["cannot be used with"]);
    }
    let late = folder.path().join("late.png");
    refused(&["render", "--with", "exact", "--at", "13", "--t-end", "12", "-o", late.to_str().unwrap()], &["0 to 12"]);
    assert!(!late.exists());
}

/// Frames with alpha, no film, and a loop of them as animated PNG; GIF cannot show them.
#[test]
fn a_transparent_background_gives_frames_with_alpha_and_no_film() {
    let folder = tempfile::tempdir().unwrap();
    let film = folder.path().join("film");
    let film = film.to_str().unwrap();
    let scene = scene_file(
        folder.path(),
        "title = \"x\"\n[simulation]\nduration = 1.0\n[film]\nwidth = 320\nheight = 180\nfps = 4\nbackground = \"transparent\"\n",
    );
    let with = ["render", &scene, "--with", "exact", "--renderer", "cpu", "-o", film];
    let output = stickslip(&with);
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success() && told.contains("H.264 has no alpha"), "{told}");
    assert!(!Path::new(film).join("film.mp4").exists());
    let frame = image::open(Path::new(film).join("frames/000000.png")).unwrap();
    let image::DynamicImage::ImageRgba8(frame) = frame else { panic!("no alpha") };
    assert_eq!(frame.get_pixel(100, 2).0[3], 0);
    assert!(frame.pixels().any(|pixel| pixel.0[3] == 255));
    let gif = folder.path().join("loop.gif");
    refused(&["animate", film, "-o", gif.to_str().unwrap()], &["translucent", ".png"]);
    let loop_ = folder.path().join("loop.png");
    assert!(stickslip(&["animate", film, "--width", "160", "-o", loop_.to_str().unwrap()]).status.success());
    let image::DynamicImage::ImageRgba8(first) = image::open(loop_).unwrap() else { panic!("no alpha") };
    assert!(first.get_pixel(50, 1).0[3] == 0);
    // The same by an option; the opaque frames of the scene are another film.
    let still = folder.path().join("still.png");
    let args = ["render", "--with", "exact", "--at", "3", "--size", "320x180", "--background", "transparent", "-o"];
    assert!(stickslip(&[&args[..], &[still.to_str().unwrap()]].concat()).status.success());
    assert!(matches!(image::open(still).unwrap(), image::DynamicImage::ImageRgba8(_)));
    refused(&[&with[..], &["--background", "theme"]].concat(), &["background", "--force"]);
}

/// Pictures can have any size; H.264 needs even sides, so the film of odd ones is a little larger, which is said.
#[test]
fn odd_sizes_are_those_of_the_pictures_and_the_film_is_even() {
    let folder = tempfile::tempdir().unwrap();
    let (still, film) = (folder.path().join("still.png"), folder.path().join("film"));
    let render = |options: &[&str]| {
        let args = ["render", "--with", "exact", "--t-end", "4", "--fps", "4", "--renderer", "cpu"];
        let output = stickslip(&[&args[..], options].concat());
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{told}");
        told
    };
    let size = |path: &Path| image::open(path).unwrap().to_rgba8().dimensions();
    let told = render(&["--at", "3.3", "--size", "321x181", "-o", still.to_str().unwrap()]);
    assert_eq!(size(&still), (321, 181));
    assert!(!told.contains("H.264"), "{told}");
    let told = render(&["--size", "65x97", "-o", film.to_str().unwrap()]);
    assert!(told.contains("H.264 needs even sides"), "{told}");
    assert_eq!(size(&film.join("frames/000002.png")), (65, 97));
    assert_eq!(crate::film::mp4::read(&fs::read(film.join("film.mp4")).unwrap()).size, [66, 98]);
    let help = String::from_utf8(stickslip(&["render", "--help"]).stdout).unwrap();
    let help = help.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(help.contains("where one is odd, film.mp4 repeats the last column or row"), "{help}");
    refused(&["render", "--size", "63x64"], &["film.width", "width = 63", "from 64 to 7680"]);
}
