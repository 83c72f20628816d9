//! The output folder: an earlier run's results go first, everything new is written aside and moved in when whole.
//!
//! The aside is a hidden folder *inside* the output folder, so that moving never crosses file systems and needs no rights
//! beside it. `report.json` is moved last: where it is, all of the run is.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// A file or folder could not be worked with.
#[derive(Debug, Error)]
#[error("cannot {action} {}: {source}", path.display())]
pub struct OutputError {
    /// What was tried.
    pub action: &'static str,
    /// On what.
    pub path: PathBuf,
    /// Why it failed.
    pub source: io::Error,
}

fn failed(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> OutputError {
    let path = path.to_path_buf();
    move |source| OutputError { action, path, source }
}

/// Name of a capture's picture: `frame_0007.png`.
#[must_use]
pub fn frame_name(index: usize) -> String {
    format!("frame_{index:04}.png")
}

/// Name of a capture's rain from above: `frame_0007_above.png`.
#[must_use]
pub fn above_name(index: usize) -> String {
    format!("frame_{index:04}_above.png")
}

/// Name of a capture's mask: `frame_0007_rain.png`.
#[must_use]
pub fn mask_name(index: usize, mask: super::file::Mask) -> String {
    format!("frame_{index:04}_{}.png", mask.suffix())
}

/// Name of the contact sheet.
pub const CONTACT: &str = "contact.png";
/// Name of the timeline plot.
pub const TIMELINE: &str = "timeline.png";
/// Name of the report.
pub const REPORT: &str = "report.json";

const ASIDE: &str = ".rain-unfinished-";

/// A run's results on their way into a folder. Dropped without [`finish`](Self::finish), it leaves none.
#[derive(Debug)]
pub struct OutputFolder {
    folder: PathBuf,
    aside: PathBuf,
    /// Names in the order they were added.
    names: Vec<String>,
}

impl OutputFolder {
    /// Creates the folder where it is missing, and removes what an earlier run left in it: frames, masks, contact sheet,
    /// timeline, report and unfinished files. Other files stay.
    ///
    /// # Errors
    /// When the folder cannot be created or written to; with its path.
    pub fn begin(folder: impl AsRef<Path>) -> Result<Self, OutputError> {
        let folder = folder.as_ref().to_path_buf();
        fs::create_dir_all(&folder).map_err(failed("create the output folder", &folder))?;
        for entry in fs::read_dir(&folder).map_err(failed("read the output folder", &folder))? {
            let entry = entry.map_err(failed("read the output folder", &folder))?;
            let (path, name) = (entry.path(), entry.file_name());
            let Some(name) = name.to_str() else { continue };
            let is_folder = entry.file_type().is_ok_and(|t| t.is_dir());
            if is_folder && name.starts_with(ASIDE) {
                fs::remove_dir_all(&path).map_err(failed("remove", &path))?;
            } else if !is_folder && is_ours(name) {
                fs::remove_file(&path).map_err(failed("remove", &path))?;
            }
        }
        let aside = folder.join(format!("{ASIDE}{}", std::process::id()));
        fs::create_dir(&aside).map_err(failed("write into the output folder", &folder))?;
        Ok(Self {
            folder,
            aside,
            names: Vec::new(),
        })
    }

    /// Writes a file aside. A later one of the same name replaces it.
    ///
    /// # Errors
    /// When it cannot be written (disk full, name that is no plain file name, …); with its path.
    pub fn write(&mut self, name: &str, bytes: &[u8]) -> Result<(), OutputError> {
        let plain = Path::new(name).file_name().is_some_and(|n| n == name);
        if !plain {
            let why = io::Error::new(io::ErrorKind::InvalidInput, "allowed: a plain file name");
            return Err(failed("write", &self.folder.join(name))(why));
        }
        let path = self.aside.join(name);
        fs::write(&path, bytes).map_err(failed("write", &path))?;
        if !self.names.iter().any(|n| n == name) {
            self.names.push(name.to_owned());
        }
        Ok(())
    }

    /// Writes a picture aside as PNG.
    ///
    /// # Errors
    /// When it cannot be encoded or written; with its path.
    pub fn write_picture(&mut self, name: &str, picture: &image::RgbImage) -> Result<(), OutputError> {
        let mut bytes = io::Cursor::new(Vec::new());
        picture
            .write_to(&mut bytes, image::ImageFormat::Png)
            .map_err(|e| failed("encode", &self.folder.join(name))(io::Error::other(e)))?;
        self.write(name, &bytes.into_inner())
    }

    /// Moves everything into the folder, `report.json` last, and returns the paths in that order.
    ///
    /// # Errors
    /// When a file cannot be moved; then there is no `report.json`.
    pub fn finish(mut self) -> Result<Vec<PathBuf>, OutputError> {
        self.names.sort_by_key(|name| name == REPORT);
        let mut paths = Vec::new();
        for name in &self.names {
            let path = self.folder.join(name);
            fs::rename(self.aside.join(name), &path).map_err(failed("move into place", &path))?;
            paths.push(path);
        }
        Ok(paths)
    }
}

impl Drop for OutputFolder {
    fn drop(&mut self) {
        // Best effort: what stays is hidden and goes with the next run.
        let _ = fs::remove_dir_all(&self.aside);
    }
}

/// Whether a run writes files of this name.
fn is_ours(name: &str) -> bool {
    if [CONTACT, TIMELINE, REPORT].contains(&name) {
        return true;
    }
    let Some(stem) = name.strip_prefix("frame_").and_then(|n| n.strip_suffix(".png")) else {
        return false;
    };
    let (number, mask) = stem.split_once('_').map_or((stem, None), |(n, m)| (n, Some(m)));
    number.len() >= 4
        && number.bytes().all(|b| b.is_ascii_digit())
        && mask.is_none_or(|m| ["rain", "wet", "depth", "water", "above"].contains(&m))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A folder of a test's own, removed at its end.
    pub struct Folder(pub PathBuf);

    impl Folder {
        pub fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("rain_scenario_{name}_{}", std::process::id()));
            let _ = fs::remove_dir_all(&path);
            fs::create_dir_all(&path).unwrap();
            Self(path)
        }

        fn names(&self) -> Vec<String> {
            let mut names: Vec<_> = fs::read_dir(&self.0)
                .unwrap()
                .map(|e| e.unwrap().file_name().into_string().unwrap())
                .collect();
            names.sort();
            names
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn stale_results_go_and_other_files_stay() {
        let folder = Folder::new("stale");
        for name in [
            "frame_0000.png",
            "frame_0001_rain.png",
            "frame_12345_depth.png",
            "contact.png",
            "timeline.png",
            "report.json",
            "frame_mine.png",
            "frame_0001_mine.png",
            "frame_01.png",
            "notes.txt",
        ] {
            fs::write(folder.0.join(name), b"old").unwrap();
        }
        fs::create_dir(folder.0.join(".rain-unfinished-1")).unwrap();
        let mut output = OutputFolder::begin(&folder.0).unwrap();
        output.write(REPORT, b"{}").unwrap();
        output.write(&frame_name(0), b"new").unwrap();
        // Nothing shows before all is there.
        let kept = ["frame_0001_mine.png", "frame_01.png", "frame_mine.png", "notes.txt"];
        let visible: Vec<_> = folder.names().into_iter().filter(|n| !n.starts_with('.')).collect();
        assert_eq!(visible, kept);
        let paths = output.finish().unwrap();
        assert_eq!(paths, [folder.0.join("frame_0000.png"), folder.0.join(REPORT)]);
        assert_eq!(fs::read(&paths[0]).unwrap(), b"new");
        let mut all = vec!["frame_0000.png"];
        all.extend(kept);
        all.push("report.json");
        assert_eq!(folder.names(), all);
    }

    #[test]
    fn an_aborted_run_leaves_nothing() {
        let folder = Folder::new("aborted");
        let mut output = OutputFolder::begin(folder.0.join("a/b")).unwrap();
        output.write(CONTACT, b"half").unwrap();
        drop(output);
        assert_eq!(fs::read_dir(folder.0.join("a/b")).unwrap().count(), 0);
    }

    #[test]
    fn errors_name_the_path() {
        let folder = Folder::new("unwritable");
        let file = folder.0.join("file");
        fs::write(&file, b"").unwrap();
        let error = OutputFolder::begin(&file).unwrap_err().to_string();
        assert!(error.contains(&*file.to_string_lossy()), "{error}");
        let error = OutputFolder::begin(file.join("below")).unwrap_err().to_string();
        assert!(error.contains("below"), "{error}");
        let mut output = OutputFolder::begin(folder.0.join("out")).unwrap();
        for name in ["../x.png", "a/b.png", "", ".."] {
            assert!(output.write(name, b"").is_err(), "{name}");
        }
        assert!(!folder.0.join("x.png").exists());
    }

    #[test]
    fn names_of_files() {
        assert_eq!(frame_name(7), "frame_0007.png");
        assert_eq!(mask_name(12, super::super::file::Mask::Wet), "frame_0012_wet.png");
        assert!(is_ours(&mask_name(99_999, super::super::file::Mask::Depth)));
    }
}
