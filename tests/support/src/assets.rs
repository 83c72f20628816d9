//! Scenes in files: the generated street, and real models where somebody has them.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use street::Layout;
use tempfile::TempDir;

/// Folder with `street.glb` and `car.glb`, generated once a process, and where everything on the street is.
///
/// # Panics
/// When the street cannot be written.
pub fn street_folder() -> (&'static Path, &'static Layout) {
    static STREET: OnceLock<(TempDir, Layout)> = OnceLock::new();
    let (folder, layout) = STREET.get_or_init(|| {
        let folder = TempDir::new().expect("a temporary folder");
        let layout = street::generate(folder.path(), street::DEFAULT_SEED).expect("the street is written");
        (folder, layout)
    });
    (folder.path(), layout)
}

/// The folder of real models that `RAIN_ASSETS` names. Without one the test says so on stderr and should return.
///
/// # Panics
/// When `RAIN_ASSETS` is set to something that is no folder: a misspelt path must not pass as a skip.
#[must_use]
pub fn real_models() -> Option<PathBuf> {
    let Some(folder) = std::env::var_os("RAIN_ASSETS").filter(|v| !v.is_empty()) else {
        eprintln!("skipped: RAIN_ASSETS names no folder of real models");
        return None;
    };
    let folder = PathBuf::from(folder);
    // Tests run in their package's folder; a relative path is meant from the repository.
    let from_repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(&folder);
    let found = [folder.clone(), from_repository].into_iter().find(|f| f.is_dir());
    assert!(
        found.is_some(),
        "RAIN_ASSETS is {}, which is no folder",
        folder.display()
    );
    found
}
