//! What the other modules read: the files of the repository and cargo's view of its packages.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use cargo_metadata::{Metadata, MetadataCommand};

/// The platform whose dependencies are looked at: the one that CI builds for.
pub const PLATFORM: &str = "x86_64-unknown-linux-gnu";

/// The workspace's folder.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .ancestors()
        .nth(2)
        .expect("tests/workspace is two levels down")
        .to_path_buf()
}

/// Every file that git tracks or would track, relative to the root, sorted, with `/` between folders.
///
/// # Panics
/// Where git cannot list them: a scan of nothing would pass.
pub fn files() -> &'static [String] {
    static FILES: OnceLock<Vec<String>> = OnceLock::new();
    FILES.get_or_init(|| {
        let output = Command::new("git")
            .current_dir(root())
            .args([
                "-c",
                "safe.directory=*",
                "ls-files",
                "-z",
                "--cached",
                "--others",
                "--exclude-standard",
            ])
            .output()
            .expect("git starts");
        assert!(
            output.status.success(),
            "git ls-files: {}",
            String::from_utf8_lossy(&output.stderr)
        );
        let mut files: Vec<String> = String::from_utf8(output.stdout)
            .expect("file names are UTF-8")
            .split('\0')
            .filter(|name| !name.is_empty() && root().join(name).is_file())
            .map(str::to_owned)
            .collect();
        files.sort();
        files.dedup();
        files
    })
}

/// The files whose names end in one of `endings`.
pub fn files_ending(endings: &[&str]) -> Vec<&'static str> {
    files()
        .iter()
        .map(String::as_str)
        .filter(|name| endings.iter().any(|ending| name.ends_with(ending)))
        .collect()
}

/// The text of a file of the repository.
///
/// # Panics
/// Where it cannot be read as UTF-8.
pub fn text(name: &str) -> String {
    std::fs::read_to_string(root().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// `cargo metadata` for [`PLATFORM`], with all features of all members.
pub fn metadata() -> &'static Metadata {
    static METADATA: OnceLock<Metadata> = OnceLock::new();
    METADATA.get_or_init(|| {
        MetadataCommand::new()
            .manifest_path(root().join("Cargo.toml"))
            .features(cargo_metadata::CargoOpt::AllFeatures)
            .other_options(vec!["--filter-platform".to_owned(), PLATFORM.to_owned()])
            .exec()
            .expect("cargo metadata runs")
    })
}
