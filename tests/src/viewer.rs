//! What a stock viewer shows of a glTF file: three.js in a browser.

use crate::browser::headless;
use crate::needs::viewer_folder;
use image::RgbImage;
use serde::Deserialize;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::{Duration, Instant};

const VIEWER: &str = include_str!("browser/viewer.js");

/// How long the viewer may take.
const LIMIT: Duration = Duration::from_secs(240);

/// What the viewer has made of a file: two pictures, as data URIs, or an error.
#[derive(Deserialize)]
#[serde(untagged)]
enum Outcome {
    Pictures(Vec<String>),
    Error(String),
}

/// Pictures of each file from two sides, 256 pixels square. Panics where the viewer cannot show a file.
pub fn pictures(files: &[PathBuf]) -> Vec<Vec<RgbImage>> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let package = viewer_folder().join("node_modules/three").canonicalize().expect("three.js");
    let imports = serde_json::json!({ "imports": {
        "three": url(&package.join("build/three.module.js")),
        "three/addons/": format!("{}/", url(&package.join("examples/jsm"))),
    } });
    let urls: Vec<String> = files.iter().map(|file| url(&file.canonicalize().expect("a file"))).collect();
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let port = listener.local_addr().expect("an address").port();
    let page = format!(
        "<!doctype html><meta charset=\"utf-8\"><script type=\"importmap\">{imports}</script>\
         <body><script type=\"application/json\" id=\"files\" data-port=\"{port}\">{}</script>\
         <script type=\"module\">{VIEWER}</script></body>",
        serde_json::json!(urls)
    );
    let path = folder.path().join("viewer.html");
    std::fs::write(&path, page).expect("a folder to write in");
    let mut browser = headless(folder.path());
    browser.args(["--allow-file-access-from-files", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]);
    browser.args(["--remote-debugging-port=0", &url(&path)]).stdout(Stdio::null());
    let mut child = browser.spawn().expect("the browser starts");
    let answer = answer(&listener);
    child.kill().and_then(|()| child.wait()).expect("the browser can be ended");
    let outcomes: Vec<Outcome> = serde_json::from_str(&answer.expect("the viewer ends in time")).expect("pictures");
    outcomes.into_iter().zip(files).map(|(outcome, file)| decoded(outcome, file)).collect()
}

/// What the page sends.
fn answer(listener: &TcpListener) -> Option<String> {
    listener.set_nonblocking(true).expect("a listener");
    let start = Instant::now();
    while start.elapsed() < LIMIT {
        match listener.accept() {
            Ok((stream, _)) => return body(stream),
            Err(_) => std::thread::sleep(Duration::from_millis(50)),
        }
    }
    None
}

/// The body of an HTTP request.
fn body(stream: TcpStream) -> Option<String> {
    stream.set_nonblocking(false).ok()?;
    let mut reader = BufReader::new(stream);
    let mut length = 0;
    loop {
        let mut line = String::new();
        reader.read_line(&mut line).ok()?;
        if line.trim().is_empty() {
            break;
        }
        if let Some((_, value)) = line.to_ascii_lowercase().split_once("content-length:") {
            length = value.trim().parse().ok()?;
        }
    }
    let mut bytes = vec![0; length];
    reader.read_exact(&mut bytes).ok()?;
    reader.get_mut().write_all(b"HTTP/1.1 204 No Content\r\n\r\n").ok()?;
    String::from_utf8(bytes).ok()
}

fn decoded(outcome: Outcome, file: &Path) -> Vec<RgbImage> {
    match outcome {
        Outcome::Error(error) => panic!("{}: {error}", file.display()),
        Outcome::Pictures(pictures) => pictures.iter().map(|picture| decode(picture)).collect(),
    }
}

fn decode(data_uri: &str) -> RgbImage {
    let (_, body) = data_uri.split_once(',').expect("a data URI");
    let png = crate::gltf_diff::base64(body).expect("base64");
    image::load_from_memory(&png).expect("a picture").to_rgb8()
}

fn url(path: &Path) -> String {
    let escape = |byte: u8| match byte {
        b'/' | b'.' | b'-' | b'_' | b'0'..=b'9' | b'a'..=b'z' | b'A'..=b'Z' => char::from(byte).to_string(),
        other => format!("%{other:02X}"),
    };
    let text: String = path.display().to_string().bytes().map(escape).collect();
    format!("file://{text}")
}
