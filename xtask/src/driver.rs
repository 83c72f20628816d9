//! A Vulkan driver: look for one, install Mesa's software driver where there is none.
//!
//! A driver is usable when the loader (`libvulkan.so.1`) is found and there is a manifest (`*_icd*.json`) that either
//! belongs to a software driver or has a graphics device to drive: a manifest alone says only that a package is
//! installed, and containers have plenty of those without a device.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::platform::{self, DEBIAN_PACKAGES, Family};

/// Exit code where there is no usable graphics device.
pub const NO_DEVICE: u8 = 3;

/// Folders in which the loader looks for manifests, besides the user's own.
const MANIFEST_DIRS: [&str; 4] = [
    "/usr/share/vulkan/icd.d",
    "/etc/vulkan/icd.d",
    "/usr/local/share/vulkan/icd.d",
    "/usr/local/etc/vulkan/icd.d",
];

/// Folders of shared libraries, for machines without `ldconfig`.
const LIBRARY_DIRS: [&str; 8] = [
    "/usr/lib/x86_64-linux-gnu",
    "/usr/lib/aarch64-linux-gnu",
    "/usr/lib64",
    "/usr/lib",
    "/lib64",
    "/lib",
    "/usr/local/lib",
    "/run/opengl-driver/lib",
];

/// Device nodes of graphics hardware: DRM render nodes, NVIDIA, WSL.
const DEVICE_NODES: [(&str, &str); 3] = [("/dev/dri", "renderD"), ("/dev", "nvidia0"), ("/dev", "dxg")];

/// What this machine offers for Vulkan.
#[derive(Clone, Debug, Default)]
pub struct Found {
    /// Whether `libvulkan.so.1` is there.
    pub loader: bool,
    /// Driver manifests that exist.
    pub manifests: Vec<PathBuf>,
    /// Whether a graphics device node exists.
    pub hardware: bool,
    /// Whether the manifests were named by the user (`VK_DRIVER_FILES`, `VK_ICD_FILENAMES`) and so are taken as usable.
    pub named: bool,
}

impl Found {
    /// The manifest of a driver that can work here, or what is missing.
    ///
    /// # Errors
    /// A phrase for the user: no loader, no manifest, or only drivers of hardware that is not there.
    pub fn usable(&self) -> Result<&Path, &'static str> {
        if !self.loader {
            return Err("no Vulkan loader (libvulkan.so.1)");
        }
        let mut of_hardware = None;
        for manifest in &self.manifests {
            if self.named || is_software(manifest) {
                return Ok(manifest);
            }
            of_hardware.get_or_insert(manifest);
        }
        match of_hardware {
            Some(manifest) if self.hardware => Ok(manifest),
            Some(_) => Err("only Vulkan drivers of hardware that this machine does not have"),
            None if self.named => Err("the file named in VK_DRIVER_FILES or VK_ICD_FILENAMES does not exist"),
            None => Err("no Vulkan driver"),
        }
    }
}

/// Whether a manifest is that of a driver that needs no hardware (lavapipe, SwiftShader), by its file name.
fn is_software(manifest: &Path) -> bool {
    let name = manifest
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .to_ascii_lowercase();
    ["lvp", "lavapipe", "swiftshader"]
        .iter()
        .any(|part| name.contains(part))
}

/// Whether a listing printed by `ldconfig -p` has the Vulkan loader.
fn listing_has_loader(listing: &str) -> bool {
    listing
        .lines()
        .any(|line| line.split_whitespace().next() == Some("libvulkan.so.1"))
}

/// Manifests in the given folders, sorted within each folder; folders that cannot be read hold none.
fn manifests_in(dirs: &[PathBuf]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for dir in dirs {
        let Ok(entries) = std::fs::read_dir(dir) else { continue };
        let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
        files.retain(|file| file.extension().is_some_and(|end| end == "json"));
        files.sort();
        found.append(&mut files);
    }
    found
}

/// The existing files of a `:`-separated list as in `VK_DRIVER_FILES`.
fn named_manifests(list: &OsString) -> Vec<PathBuf> {
    std::env::split_paths(list).filter(|file| file.is_file()).collect()
}

/// Whether some entry of `dir` has a name that starts with `prefix`.
fn has_node(dir: &str, prefix: &str) -> bool {
    std::fs::read_dir(dir).is_ok_and(|entries| {
        entries
            .flatten()
            .any(|entry| entry.file_name().to_string_lossy().starts_with(prefix))
    })
}

/// Looks at this machine.
fn look() -> Found {
    let loader = ["ldconfig", "/sbin/ldconfig", "/usr/sbin/ldconfig"]
        .iter()
        .any(|program| {
            Command::new(program)
                .arg("-p")
                .stderr(Stdio::null())
                .output()
                .is_ok_and(|output| listing_has_loader(&String::from_utf8_lossy(&output.stdout)))
        })
        || std::env::var_os("LD_LIBRARY_PATH")
            .iter()
            .flat_map(std::env::split_paths)
            .chain(LIBRARY_DIRS.iter().map(PathBuf::from))
            .any(|dir| dir.join("libvulkan.so.1").exists());
    let hardware = DEVICE_NODES.iter().any(|(dir, prefix)| has_node(dir, prefix));

    let list = ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"]
        .iter()
        .find_map(std::env::var_os);
    if let Some(list) = list.filter(|list| !list.is_empty()) {
        return Found {
            loader,
            manifests: named_manifests(&list),
            hardware,
            named: true,
        };
    }
    let mut dirs: Vec<PathBuf> = MANIFEST_DIRS.iter().map(PathBuf::from).collect();
    if let Some(home) = std::env::var_os("HOME") {
        dirs.push(Path::new(&home).join(".local/share/vulkan/icd.d"));
    }
    Found {
        loader,
        manifests: manifests_in(&dirs),
        hardware,
        named: false,
    }
}

/// Makes sure that a Vulkan driver is there, installing Mesa's software driver on Debian and its kin.
///
/// # Errors
/// [`NO_DEVICE`], after a message with the line to run, where it cannot install one.
pub fn ensure() -> Result<(), u8> {
    if !cfg!(target_os = "linux") {
        eprintln!("xtask: Vulkan set-up is for Linux; this system's own graphics driver is used");
        return Ok(());
    }
    let found = look();
    let why = match found.usable() {
        Ok(manifest) => {
            eprintln!("xtask: Vulkan driver {}", manifest.display());
            return Ok(());
        }
        Err(why) => why,
    };
    if found.named && found.loader {
        // Whoever chose a driver wants that one: another installed beside it would not be used.
        eprintln!("xtask: {why}");
        return Err(NO_DEVICE);
    }
    let family = platform::family(&std::fs::read_to_string("/etc/os-release").unwrap_or_default());
    if family == Family::Debian {
        eprintln!("xtask: {why}; installing {}", DEBIAN_PACKAGES.join(" "));
        install_on_debian();
        if let Ok(manifest) = look().usable() {
            eprintln!("xtask: Vulkan driver {}", manifest.display());
            return Ok(());
        }
    }
    eprintln!(
        "xtask: {why}. Run this, then try again:\n\n    {}\n",
        platform::install_line(family)
    );
    Err(NO_DEVICE)
}

/// Runs apt-get, as root or through a `sudo` that asks for no password. Whether it helped is for the caller to look.
fn install_on_debian() {
    let succeeds = |program: &str, args: &[&str]| {
        Command::new(program)
            .args(args)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status()
            .is_ok_and(|status| status.success())
    };
    let root = Command::new("id")
        .arg("-u")
        .output()
        .is_ok_and(|output| output.stdout.trim_ascii() == b"0");
    if !root && !succeeds("sudo", &["-n", "true"]) {
        eprintln!("xtask: not root, and sudo is missing or asks for a password");
        return;
    }
    let install = [&["install", "-y", "--no-install-recommends"][..], &DEBIAN_PACKAGES[..]].concat();
    // A failed update is not the end: the lists at hand may do.
    for args in [vec!["update"], install] {
        let mut command = Command::new(if root { "env" } else { "sudo" });
        if !root {
            command.args(["-n", "env"]);
        }
        command
            .arg("DEBIAN_FRONTEND=noninteractive")
            .arg("apt-get")
            .args(&args)
            .stdin(Stdio::null());
        match command.status() {
            Ok(status) if status.success() => {}
            Ok(status) => eprintln!("xtask: apt-get {} ended with {status}", args[0]),
            Err(error) => eprintln!("xtask: apt-get {} did not start: {error}", args[0]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(manifests: &[&str]) -> Found {
        Found {
            loader: true,
            manifests: manifests.iter().map(PathBuf::from).collect(),
            ..Found::default()
        }
    }

    #[test]
    fn the_loader_is_read_from_the_listing() {
        let listing =
            "3 libs found in cache\n\tlibvulkan.so.1 (libc6,x86-64) => /lib/libvulkan.so.1\n\tlibz.so.1 (libc6)\n";
        assert!(listing_has_loader(listing));
        assert!(!listing_has_loader(
            "\tlibvulkan_lvp.so (libc6,x86-64) => /usr/lib/libvulkan_lvp.so\n"
        ));
        assert!(!listing_has_loader(
            "\tlibvulkan.so.10 (libc6) => /lib/libvulkan.so.10\n"
        ));
    }

    #[test]
    fn software_driver_needs_no_hardware() {
        let machine = found(&["/d/intel_icd.x86_64.json", "/d/lvp_icd.x86_64.json"]);
        assert_eq!(machine.usable(), Ok(Path::new("/d/lvp_icd.x86_64.json")));
    }

    #[test]
    fn hardware_driver_needs_its_device() {
        let mut machine = found(&["/d/nvidia_icd.json"]);
        assert!(machine.usable().unwrap_err().contains("hardware"));
        machine.hardware = true;
        assert_eq!(machine.usable(), Ok(Path::new("/d/nvidia_icd.json")));
    }

    #[test]
    fn no_loader_or_no_manifest_is_not_usable() {
        let mut machine = found(&["/d/lvp_icd.json"]);
        machine.loader = false;
        assert!(machine.usable().unwrap_err().contains("libvulkan.so.1"));
        assert_eq!(found(&[]).usable(), Err("no Vulkan driver"));
    }

    #[test]
    fn manifests_named_by_the_user_are_taken() {
        let mut machine = found(&["/opt/own.json"]);
        machine.named = true;
        assert_eq!(machine.usable(), Ok(Path::new("/opt/own.json")));
        machine.manifests.clear();
        assert!(machine.usable().unwrap_err().contains("VK_DRIVER_FILES"));
    }

    #[test]
    fn folders_are_scanned_for_json_only() {
        let dir = std::env::temp_dir().join(format!("xtask-manifests-{}", std::process::id()));
        std::fs::create_dir_all(&dir).unwrap();
        for name in ["b_icd.json", "a_icd.json", "readme.txt"] {
            std::fs::write(dir.join(name), "{}").unwrap();
        }
        let absent = dir.join("absent");
        let found = manifests_in(&[absent.clone(), dir.clone()]);
        let list = std::env::join_paths([dir.join("a_icd.json"), absent]).unwrap();
        let named = named_manifests(&list);
        std::fs::remove_dir_all(&dir).unwrap();
        assert_eq!(found, [dir.join("a_icd.json"), dir.join("b_icd.json")]);
        assert_eq!(named, [dir.join("a_icd.json")]);
    }
}
