use crate::small_disk::{SmallDisk, names_in, unwritable_place};
use std::fs::{self, File};
use std::io;
use std::path::Path;
use stickslip::store::{StoreError, read_whole, remove_leftovers, write_atomically};

#[test]
fn a_file_appears_whole_in_a_new_directory_and_leaves_nothing_else() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("a/b/file.txt");
    write_atomically(&path, |w| w.write_all(b"whole")).unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"whole");
    assert_eq!(names_in(path.parent().unwrap()), ["file.txt"]);
}

#[cfg(unix)]
#[test]
fn a_file_has_the_permissions_of_any_new_file() {
    use std::os::unix::fs::PermissionsExt;
    let place = tempfile::tempdir().unwrap();
    fs::write(place.path().join("plain"), "").unwrap();
    write_atomically(&place.path().join("atomic"), |_| Ok(())).unwrap();
    let mode = |name| fs::metadata(place.path().join(name)).unwrap().permissions().mode();
    assert_eq!(mode("atomic"), mode("plain"));
}

#[test]
fn a_failure_midway_leaves_the_old_file_and_no_temporary() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("file.txt");
    fs::write(&path, "old").unwrap();
    let failed = write_atomically(&path, |w| {
        // More than any buffer, so that some of it reaches the disk.
        w.write_all(&[b'x'; 100_000])?;
        Err(io::Error::other("the source dried up"))
    });
    let message = failed.unwrap_err().to_string();
    assert!(message.contains("file.txt") && message.contains("the source dried up"), "{message}");
    assert_eq!(fs::read(&path).unwrap(), b"old");
    assert_eq!(names_in(place.path()), ["file.txt"]);
}

#[test]
fn a_full_disk_is_named_and_the_old_file_stays() {
    let Some(disk) = SmallDisk::mount(64) else { return };
    let path = disk.path().join("file.txt");
    write_atomically(&path, |w| w.write_all(b"old")).unwrap();
    let error = write_atomically(&path, |w| w.write_all(&[0; 100_000])).unwrap_err();
    assert!(matches!(&error, StoreError::Write { source, .. } if source.kind() == io::ErrorKind::StorageFull));
    let message = error.to_string();
    assert!(message.contains("file.txt") && message.contains("Free some space"), "{message}");
    assert_eq!(fs::read(&path).unwrap(), b"old");
    assert_eq!(names_in(disk.path()), ["file.txt"]);
}

#[test]
fn a_directory_that_cannot_be_is_an_error_that_names_it() {
    let place = tempfile::tempdir().unwrap();
    let path = unwritable_place(place.path()).join("file.txt");
    let error = write_atomically(&path, |w| w.write_all(b"x")).unwrap_err();
    assert!(matches!(error, StoreError::CreateDirectory { .. }), "{error}");
    assert!(error.to_string().contains("plain file"), "{error}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_directory_that_takes_no_files_is_an_error_that_names_the_file() {
    // Even root cannot make files in /proc.
    let error = write_atomically("/proc/stickslip.txt".as_ref(), |w| w.write_all(b"x")).unwrap_err();
    assert!(matches!(error, StoreError::Write { .. }), "{error}");
    assert!(error.to_string().contains("/proc/stickslip.txt"), "{error}");
}

#[test]
fn a_directory_in_the_place_of_the_file_is_an_error_and_stays() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("taken");
    fs::create_dir(&path).unwrap();
    fs::write(path.join("inside"), "kept").unwrap();
    assert!(matches!(write_atomically(&path, |_| Ok(())), Err(StoreError::Write { .. })));
    assert_eq!(names_in(place.path()), ["taken"]);
    assert_eq!(fs::read(path.join("inside")).unwrap(), b"kept");
}

#[test]
fn leftovers_are_removed_but_not_files_of_others_or_of_a_live_run() {
    let place = tempfile::tempdir().unwrap();
    let at = |name: &str| place.path().join(name);
    fs::write(at(".stickslip-partial-dead"), "half").unwrap();
    fs::write(at("notes.txt"), "mine").unwrap();
    write_atomically(&at("file.txt"), |w| {
        w.write_all(b"being written")?;
        // The live temporary is in the directory now.
        assert_eq!(names_in(place.path()).len(), 3);
        assert_eq!(remove_leftovers(place.path()).unwrap(), 1);
        Ok(())
    })
    .unwrap();
    assert_eq!(names_in(place.path()), ["file.txt", "notes.txt"]);
    assert_eq!(remove_leftovers(&at("nowhere")).unwrap(), 0);
}

#[cfg(unix)]
#[test]
fn a_file_without_an_end_is_refused_and_so_is_a_huge_one() {
    let endless = read_whole(Path::new("/dev/zero")).unwrap_err().to_string();
    assert!(endless.contains("/dev/zero is larger than 64 MiB"), "{endless}");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("huge");
    // Without blocks on the disk.
    File::create(&path).unwrap().set_len(1 << 40).unwrap();
    let huge = read_whole(&path).unwrap_err().to_string();
    assert!(huge.contains("huge is larger than 512 MiB"), "{huge}");
    fs::write(&path, "short").unwrap();
    assert_eq!(read_whole(&path).unwrap(), b"short");
}
