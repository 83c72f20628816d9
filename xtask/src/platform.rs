//! Which Linux distribution this is, and how it installs a software Vulkan driver.

/// Families of distributions that share a package manager.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// Debian, Ubuntu and what derives from them.
    Debian,
    /// Fedora, RHEL, CentOS.
    Fedora,
    /// Arch Linux.
    Arch,
    /// openSUSE, SLES.
    Suse,
    /// Alpine.
    Alpine,
    /// Anything else.
    Other,
}

/// Debian packages with Mesa's Vulkan drivers (software driver included) and the loader.
pub const DEBIAN_PACKAGES: [&str; 2] = ["mesa-vulkan-drivers", "libvulkan1"];

/// Reads the text of `/etc/os-release`: its ID first, then ID_LIKE.
pub fn family(os_release: &str) -> Family {
    let value = |key: &str| {
        os_release
            .lines()
            .filter_map(|line| line.trim().split_once('='))
            .find(|(name, _)| *name == key)
            .map(|(_, value)| value.trim_matches(['"', '\'']).to_ascii_lowercase())
            .unwrap_or_default()
    };
    let names = format!("{} {}", value("ID"), value("ID_LIKE"));
    for name in names.split_whitespace() {
        match name {
            "debian" | "ubuntu" => return Family::Debian,
            "fedora" | "rhel" | "centos" => return Family::Fedora,
            "arch" => return Family::Arch,
            "suse" | "opensuse" => return Family::Suse,
            "alpine" => return Family::Alpine,
            _ => {}
        }
    }
    Family::Other
}

/// The line that installs a software Vulkan driver by hand.
pub fn install_line(family: Family) -> String {
    match family {
        Family::Debian => {
            format!(
                "sudo sh -c 'apt-get update && apt-get install -y {}'",
                DEBIAN_PACKAGES.join(" ")
            )
        }
        Family::Fedora => "sudo dnf install mesa-vulkan-drivers vulkan-loader".to_owned(),
        Family::Arch => "sudo pacman -S vulkan-swrast vulkan-icd-loader".to_owned(),
        Family::Suse => "sudo zypper install libvulkan_lvp libvulkan1".to_owned(),
        Family::Alpine => "sudo apk add mesa-vulkan-swrast vulkan-loader".to_owned(),
        Family::Other => "install Mesa's Vulkan drivers (lavapipe) and the Vulkan loader (libvulkan.so.1)".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn families_are_told_apart() {
        let debian = "PRETTY_NAME=\"Debian GNU/Linux 12 (bookworm)\"\nNAME=\"Debian GNU/Linux\"\nID=debian\n";
        let mint = "ID=linuxmint\nID_LIKE=\"ubuntu debian\"\n";
        let rocky = "ID=\"rocky\"\nID_LIKE=\"rhel centos fedora\"\n";
        let leap = "ID=\"opensuse-leap\"\nID_LIKE=\"suse opensuse\"\n";
        assert_eq!(family(debian), Family::Debian);
        assert_eq!(family(mint), Family::Debian);
        assert_eq!(family(rocky), Family::Fedora);
        assert_eq!(family(leap), Family::Suse);
        assert_eq!(family("ID=arch\n"), Family::Arch);
        assert_eq!(family("ID=alpine\n"), Family::Alpine);
        assert_eq!(family("ID=nixos\n"), Family::Other);
        assert_eq!(family(""), Family::Other);
    }

    #[test]
    fn a_version_or_name_alone_decides_nothing() {
        assert_eq!(family("VERSION_ID=debian\nPRETTY_NAME=\"debian\"\n"), Family::Other);
    }

    #[test]
    fn the_debian_line_names_both_packages() {
        let line = install_line(Family::Debian);
        assert!(DEBIAN_PACKAGES.iter().all(|package| line.contains(package)), "{line}");
    }
}
