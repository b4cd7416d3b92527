//! Paths of documents: relative on disk, so that a folder can be moved; absolute in memory.

use std::path::{Component, Path, PathBuf};

/// A path as a document in `folder` stores it: relative with `/` where both have a common root, else unchanged.
pub fn relative(path: &str, folder: &Path) -> String {
    let (target, from) = (normal(Path::new(path)), normal(folder));
    if !target.is_absolute() || !from.is_absolute() {
        return path.into();
    }
    let (target, from): (Vec<Component>, Vec<Component>) = (target.components().collect(), from.components().collect());
    let shared = target.iter().zip(&from).take_while(|(a, b)| a == b).count();
    let root = target.iter().take_while(|part| matches!(part, Component::Prefix(_) | Component::RootDir)).count();
    if shared < root {
        return path.into();
    }
    let up = (shared..from.len()).map(|_| "..".to_string());
    let down = target.iter().skip(shared).map(|part| part.as_os_str().to_string_lossy().into_owned());
    up.chain(down).collect::<Vec<_>>().join("/")
}

/// A stored path seen from `folder`, without `.` and `..`.
pub fn absolute(stored: &str, folder: &Path) -> String {
    normal(&folder.join(stored)).to_string_lossy().into_owned()
}

/// Without `.` and `..`, by the text alone: links are not followed.
fn normal(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if matches!(out.components().next_back(), Some(Component::Normal(_))) => _ = out.pop(),
            // Above the root is the root.
            Component::ParentDir if out.has_root() => {}
            part => out.push(part),
        }
    }
    out
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn a_path_goes_to_disk_and_back() {
        let folder = Path::new("/home/a/desk");
        for (path, stored) in [
            ("/home/a/desk/m/x.glb", "m/x.glb"),
            ("/home/a/x.glb", "../x.glb"),
            ("/data/x.glb", "../../../data/x.glb"),
            ("/home/a/desktop/x.glb", "../desktop/x.glb"),
        ] {
            assert_eq!(relative(path, folder), stored);
            assert_eq!(absolute(stored, folder), path);
        }
    }

    #[test]
    fn an_absolute_path_in_a_file_stays() {
        assert_eq!(absolute("/data/x.glb", Path::new("/home/a")), "/data/x.glb");
        assert_eq!(absolute("../../../../x.glb", Path::new("/home/a")), "/x.glb");
    }
}
