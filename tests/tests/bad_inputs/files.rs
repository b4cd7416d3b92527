//! Paths that lead away from the model's folder, and files that are none.

use std::fs;
use std::path::{Path, PathBuf};

use burnish_core::import::{FolderResolver, ImportOptions, Resolver, load_environment, load_scene};
use serde_json::json;

use crate::sources::triangle;

/// A folder of its own that is removed at the end, with `model/` inside and a secret beside it.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("burnish-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(path.join("model/sub")).expect("a folder in the temporary folder");
        fs::write(path.join("secret.bin"), [7; 36]).expect("a file");
        fs::write(path.join("model/in.bin"), [0; 36]).expect("a file");
        fs::write(path.join("model/sub/a b.bin"), [0; 36]).expect("a file");
        Folder(path)
    }

    fn model(&self) -> PathBuf {
        self.0.join("model")
    }

    fn resolver(&self) -> FolderResolver {
        FolderResolver::new(&self.model()).expect("the folder is there")
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[track_caller]
fn refused(resolver: &FolderResolver, uri: &str, words: &str) {
    let text = resolver.read(uri, 1000).expect_err(uri).to_string();
    assert!(text.contains(words), "{uri:?}: {text:?} lacks {words:?}");
}

#[test]
fn uris_that_leave_the_folder_are_refused_each_in_its_words() {
    let folder = Folder::new("uris");
    let resolver = folder.resolver();
    for (uri, words) in [
        ("../secret.bin", "'../secret.bin' leads out of the model's folder by `..`"),
        ("..%2fsecret.bin", "'..%2fsecret.bin' leads out"),
        ("%2e%2e/secret.bin", "leads out"),
        ("..\\secret.bin", "leads out"),
        ("%2e%2e%5csecret.bin", "leads out"),
        ("sub/../../secret.bin", "leads out"),
        ("/etc/passwd", "absolute path"),
        ("%2fetc%2fpasswd", "absolute path"),
        ("\\x", "absolute path"),
        ("C:\\x.bin", "a drive or stream"),
        ("C%3a/x.bin", "a drive or stream"),
        ("in.bin:stream", "has the scheme `in.bin`"),
        ("\\\\host\\x", "network host"),
        ("//host/x", "network host"),
        ("file:///etc/passwd", "has the scheme `file`"),
        ("HTTP://host/x", "has the scheme `http`"),
        ("a\0b", "control character"),
        ("a%00b", "control character"),
        ("%FF%FE.bin", "'%FF%FE.bin' is not UTF-8"),
        ("", "empty"),
        ("./", "empty"),
        ("CON", "reserved by Windows"),
        ("sub/nul.bin", "`nul.bin`, a device name reserved by Windows"),
        ("com1.png", "reserved by Windows"),
        ("gone.bin", "'gone.bin' does not exist"),
    ] {
        refused(&resolver, uri, words);
    }
    for uri in ["in.bin", "sub/a%20b.bin", "sub\\a b.bin", "sub/../in.bin", "./in.bin", "console.bin/../in.bin"] {
        assert_eq!(resolver.read(uri, 36).map(|b| b.len()), Ok(36), "{uri}");
    }
}

#[test]
fn a_file_over_the_budget_is_refused_unread() {
    let folder = Folder::new("budget");
    let text = folder.resolver().read("in.bin", 35).expect_err("too large").to_string();
    assert_eq!(text, "'in.bin' has 36 bytes; 35 may be read");
}

#[cfg(unix)]
#[test]
fn links_out_and_files_that_are_no_files_are_refused_and_links_within_are_read() {
    use std::os::unix::fs::symlink;
    let folder = Folder::new("links");
    let (model, resolver) = (folder.model(), folder.resolver());
    symlink(folder.0.join("secret.bin"), model.join("out.bin")).expect("a link");
    symlink("..", model.join("up")).expect("a link");
    symlink("in.bin", model.join("within.bin")).expect("a link");
    symlink("loop.bin", model.join("loop.bin")).expect("a link");
    let _socket = std::os::unix::net::UnixListener::bind(model.join("socket.bin")).expect("a socket");
    refused(&resolver, "out.bin", "leads out of the model's folder through a symbolic link");
    refused(&resolver, "up/secret.bin", "through a symbolic link");
    refused(&resolver, "sub", "'sub' is a folder, not a regular file");
    refused(&resolver, "socket.bin", "is a socket");
    refused(&resolver, "loop.bin", "'loop.bin' cannot be read");
    assert!(resolver.read("within.bin", 36).is_ok());

    let status = std::process::Command::new("mkfifo").arg(model.join("pipe.bin")).status();
    if status.is_ok_and(|s| s.success()) {
        refused(&resolver, "pipe.bin", "is a named pipe");
        let text = load_environment(&model.join("pipe.bin")).expect_err("a pipe").to_string();
        assert!(text.starts_with("pipe.bin: file: ") && text.contains("is a named pipe"), "{text}");
    }
    if Path::new("/dev/zero").exists() {
        let text = load_scene(Path::new("/dev/zero"), &ImportOptions::default()).expect_err("a device").to_string();
        assert!(text.contains("is a device, not a regular file"), "{text}");
    }
}

#[test]
fn a_model_that_asks_for_other_files_is_refused_with_file_and_buffer() {
    let folder = Folder::new("model");
    let mut model = triangle();
    model["buffers"][0]["uri"] = "../secret.bin".into();
    let path = folder.model().join("thief.gltf");
    fs::write(&path, model.to_string()).expect("a file");
    let text = load_scene(&path, &ImportOptions::default()).expect_err("refused").to_string();
    assert!(text.starts_with("thief.gltf: buffer 0: '../secret.bin' leads out of the model's folder"), "{text}");
    assert!(text.contains("put the file into the model's folder"), "{text}");

    model["buffers"][0] = json!({ "byteLength": 36, "uri": "in.bin" });
    fs::write(&path, model.to_string()).expect("a file");
    let imported = load_scene(&path, &ImportOptions::default()).expect("read");
    assert!(imported.notices[0].to_string().contains("no area"), "{:?}", imported.notices);
}

#[test]
fn obj_libraries_and_their_maps_stay_inside_too() {
    let folder = Folder::new("obj");
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let path = folder.model().join("m.obj");
    for (name, words) in [("../../all.mtl", "leads out"), ("/etc/passwd", "absolute path"), ("..\\x.mtl", "leads out")]
    {
        fs::write(&path, format!("mtllib {name}\n{corners}f 1 2 3\n")).expect("a file");
        let notices = load_scene(&path, &ImportOptions::default()).expect("read").notices;
        let text = notices[0].to_string();
        assert!(text.starts_with("m.obj: mtllib ") && text.contains(words), "{text}");
    }
    fs::write(folder.model().join("m.mtl"), "newmtl a\nmap_Kd -bm 1 ../x.png\n").expect("a file");
    fs::write(&path, format!("mtllib m.mtl\n{corners}usemtl a\nf 1 2 3\n")).expect("a file");
    let text = load_scene(&path, &ImportOptions::default()).expect("read").notices[0].to_string();
    assert!(text.contains("m.obj: material 'a': texture '../x.png' is left out: '../x.png' leads out"), "{text}");
}

#[test]
fn a_model_that_is_not_there_is_refused_by_name() {
    let folder = Folder::new("gone");
    let text = load_scene(&folder.model().join("gone.glb"), &ImportOptions::default()).expect_err("gone").to_string();
    assert!(text.starts_with("gone.glb: file: ") && text.contains("does not exist"), "{text}");
    let text = load_scene(&folder.model(), &ImportOptions::default()).expect_err("a folder").to_string();
    assert!(text.starts_with("model: file: ") && text.contains("is a folder"), "{text}");
}
