//! H.264 in MP4 by an installed ffmpeg: 4:2:0 pictures go to its standard input, and the file it writes under a temporary name is
//! taken over when it has ended well.
//!
//! The pictures are converted here, so that colours are those of the built-in encoder whatever ffmpeg's defaults are.

use super::error::FilmError;
use super::settings::FilmSettings;
use super::yuv::Planes;
use image::RgbaImage;
use openh264::formats::YUVSource;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStderr, ChildStdin, Command, Stdio};
use std::thread::{self, JoinHandle};
use std::{env, fs::File};
use tempfile::NamedTempFile;

/// An ffmpeg that answered.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Ffmpeg {
    pub program: PathBuf,
    /// The first line it says of itself, such as `ffmpeg version 7.1`.
    pub version: String,
}

/// Of what ffmpeg complains about, this many bytes are kept.
const MOST_WORDS: u64 = 4000;

impl Ffmpeg {
    /// The ffmpeg on the search path.
    ///
    /// # Errors
    /// [`FilmError::NoFfmpeg`] if there is none, or it does not run.
    pub fn find() -> Result<Self, FilmError> {
        let folders = env::var_os("PATH").unwrap_or_default();
        let name = format!("ffmpeg{}", env::consts::EXE_SUFFIX);
        let program = env::split_paths(&folders).map(|folder| folder.join(&name)).find(|path| path.is_file());
        program.map_or_else(|| Err(FilmError::NoFfmpeg { reason: "none is on the search path".to_owned() }), Self::at)
    }

    /// The ffmpeg at `program`.
    ///
    /// # Errors
    /// [`FilmError::NoFfmpeg`] if it does not run.
    pub fn at(program: PathBuf) -> Result<Self, FilmError> {
        let refuse = |reason: String| FilmError::NoFfmpeg { reason: format!("{}: {reason}", program.display()) };
        let output =
            Command::new(&program).arg("-version").stdin(Stdio::null()).output().map_err(|e| refuse(e.to_string()))?;
        if !output.status.success() {
            return Err(refuse(output.status.to_string()));
        }
        let said = String::from_utf8_lossy(&output.stdout);
        let version = said.lines().next().unwrap_or_default().to_owned();
        Ok(Self { program, version })
    }
}

/// What ffmpeg is told, but for the name of the file it writes.
pub(super) fn arguments(settings: &FilmSettings) -> Vec<String> {
    let [width, height] = settings.video_size();
    let colours = "-color_range tv -colorspace bt709 -color_primaries bt709 -color_trc bt709";
    let input = format!(
        "-f rawvideo -pix_fmt yuv420p -video_size {width}x{height} -framerate {} {colours} -i pipe:0",
        settings.frames_per_second
    );
    // A key frame every two seconds, to jump to; the header before the pictures, for browsers; nothing about the machine.
    let output = format!(
        "-an -c:v libx264 -preset medium -crf {} -g {} -pix_fmt yuv420p {colours} -movflags +faststart -fflags +bitexact \
         -flags:v +bitexact -f mp4",
        settings.quantiser,
        2 * settings.frames_per_second
    );
    let words = ["-hide_banner -nostats -loglevel error -y", &input, &output].join(" ");
    words.split_whitespace().map(str::to_owned).collect()
}

/// A running ffmpeg.
pub(super) struct FfmpegEncoder {
    child: Child,
    /// `None` once all pictures are sent.
    input: Option<ChildStdin>,
    complaints: Option<JoinHandle<String>>,
    planes: Planes,
    file: NamedTempFile,
}

impl FfmpegEncoder {
    /// Starts ffmpeg, which writes to `file`.
    pub fn new(settings: &FilmSettings, ffmpeg: &Ffmpeg, file: NamedTempFile) -> Result<Self, FilmError> {
        let refuse =
            |error: io::Error| FilmError::NoFfmpeg { reason: format!("{}: {error}", ffmpeg.program.display()) };
        let mut command = Command::new(&ffmpeg.program);
        command.args(arguments(settings)).arg(absolute(file.path()).map_err(refuse)?);
        command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
        let mut child = command.spawn().map_err(refuse)?;
        let (input, errors) = (child.stdin.take(), child.stderr.take());
        // Read beside: an ffmpeg that says much would wait for its reader for ever.
        let complaints = errors.map(|errors| thread::spawn(|| all_words(errors)));
        Ok(Self { child, input, complaints, planes: Planes::new(settings.video_size()), file })
    }

    /// Sends the next picture.
    pub fn push(&mut self, image: &RgbaImage) -> Result<(), FilmError> {
        self.planes.fill(image);
        let planes = [self.planes.y(), self.planes.u(), self.planes.v()];
        let Some(input) = &mut self.input else { return Ok(()) };
        let sent = planes.into_iter().try_for_each(|plane| input.write_all(plane));
        // It has ended before its time; why, it says itself.
        sent.map_err(|error| self.end().err().unwrap_or_else(|| failed(format!("it took no more pictures: {error}"))))
    }

    /// Waits for the end of ffmpeg.
    fn end(&mut self) -> Result<(), FilmError> {
        drop(self.input.take());
        let status = self.child.wait().map_err(|error| failed(error.to_string()))?;
        let words = self.complaints.take().and_then(|reader| reader.join().ok()).unwrap_or_default();
        if status.success() { Ok(()) } else { Err(failed(format!("{status}: {}", words.trim()))) }
    }

    /// The finished film.
    pub fn finish(mut self) -> Result<File, FilmError> {
        self.end()?;
        let file = File::open(self.file.path()).map_err(|error| failed(error.to_string()))?;
        match file.metadata() {
            Ok(about) if about.len() > 0 => Ok(file),
            Ok(_) => Err(failed("it ended well, but wrote nothing".to_owned())),
            Err(error) => Err(failed(error.to_string())),
        }
    }
}

impl Drop for FfmpegEncoder {
    /// Where the film is given up, ffmpeg is not left behind. It has ended already otherwise, and both calls do nothing.
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn failed(reason: String) -> FilmError {
    FilmError::Ffmpeg { reason }
}

/// ffmpeg takes a relative name that begins with a dash for an option.
fn absolute(path: &Path) -> io::Result<PathBuf> {
    std::path::absolute(path)
}

/// What ffmpeg says first, which is the cause of the rest.
fn all_words(mut errors: ChildStderr) -> String {
    let mut words = Vec::new();
    // A complaint that cannot be read to its end is still worth showing.
    let _ = errors.by_ref().take(MOST_WORDS).read_to_end(&mut words);
    let _ = io::copy(&mut errors, &mut io::sink());
    String::from_utf8_lossy(&words).into_owned()
}
