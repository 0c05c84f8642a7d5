//! A disk that is full soon: a tmpfs of a few kilobytes, where the tests may mount one.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use tempfile::TempDir;

pub struct SmallDisk {
    directory: TempDir,
}

impl SmallDisk {
    /// `None`, with a word, where mounting is not allowed.
    pub fn mount(kilobytes: u32) -> Option<Self> {
        let disk = Self { directory: tempfile::tempdir().unwrap() };
        let options = format!("size={kilobytes}k");
        let mut mount = Command::new("mount");
        mount.args(["-t", "tmpfs", "-o", &options, "tmpfs"]).arg(disk.path()).stderr(Stdio::null());
        if mount.status().is_ok_and(|status| status.success()) {
            return Some(disk);
        }
        eprintln!("skipped: no tmpfs can be mounted here, which takes Linux and root");
        None
    }

    pub fn path(&self) -> &Path {
        self.directory.path()
    }

    pub fn grow(&self, kilobytes: u32) {
        let options = format!("remount,size={kilobytes}k");
        assert!(Command::new("mount").args(["-o", &options]).arg(self.path()).status().unwrap().success());
    }
}

impl Drop for SmallDisk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(self.path()).stderr(Stdio::null()).status();
    }
}

/// Names of everything in a directory, sorted.
pub fn names_in(directory: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(directory).unwrap();
    let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Path of a place below a regular file: nobody, not even root, can write there.
pub fn unwritable_place(directory: &Path) -> PathBuf {
    let file = directory.join("plain file");
    std::fs::write(&file, "in the way").unwrap();
    file.join("below")
}
