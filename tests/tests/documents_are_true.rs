//! Documents: links resolve, lengths and widths are bounded, the format names every field, the code for engines is
//! the code that is tested, and no renamed word is left, in code neither.

use std::path::{Path, PathBuf};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");
/// Names that were given up, each in two parts so that a search for them does not end here.
const RENAMED: [[&str; 2]; 5] =
    [["open", "ness"], ["Conten", "der"], ["find_", "lit"], ["find_", "ambient"], ["Thr", "own"]];

/// Every Markdown file of the repository, with its text.
fn documents() -> Vec<(PathBuf, String)> {
    let folders = [".", "docs", "docs/measurements", "assets", "tests"];
    let files = folders.iter().flat_map(|folder| std::fs::read_dir(Path::new(ROOT).join(folder)).unwrap());
    let paths = files.map(|entry| entry.unwrap().path()).filter(|path| path.extension().is_some_and(|e| e == "md"));
    let documents: Vec<_> = paths.map(|path| (path.clone(), read(path))).collect();
    assert!(documents.len() > 15, "only {} documents were found", documents.len());
    documents
}

fn read(path: impl AsRef<Path>) -> String {
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.as_ref().display()))
}

/// Lines outside of code blocks.
fn prose(text: &str) -> impl Iterator<Item = &str> {
    let mut is_code = false;
    text.lines().filter(move |line| {
        let is_fence = line.starts_with("```");
        is_code ^= is_fence;
        !is_code && !is_fence && !line.starts_with("    ")
    })
}

/// The anchor that a heading has on a page.
fn anchor(heading: &str) -> String {
    let kept = heading.trim_start_matches('#').trim().to_lowercase();
    kept.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c)).collect::<String>().replace(' ', "-")
}

#[test]
fn links_and_anchors_resolve() {
    for (path, text) in documents() {
        let targets = text.split("](").skip(1).map(|rest| rest.split(')').next().unwrap());
        for target in targets.filter(|target| !target.contains("://")) {
            let (file, wanted) = target.split_once('#').unwrap_or((target, ""));
            let file = if file.is_empty() { path.clone() } else { path.parent().unwrap().join(file) };
            assert!(file.exists(), "{}: {target} leads nowhere", path.display());
            let is_there = || prose(&read(&file)).any(|line| line.starts_with('#') && anchor(line) == wanted);
            assert!(wanted.is_empty() || is_there(), "{}: {target} has no such heading", path.display());
        }
    }
}

#[test]
fn documents_are_short_and_use_the_words_of_the_code() {
    for (path, text) in documents() {
        let is_first = ["README.md", "ARCHITECTURE.md"].iter().any(|name| path.ends_with(name));
        assert!(!is_first || text.lines().count() <= 120, "{} is too long", path.display());
        let is_bound = |line: &&str| !line.starts_with(['|', '!']) && !line.contains("](");
        let wide = prose(&text).filter(is_bound).find(|line| line.chars().count() > 100);
        assert_eq!(wide, None, "{} has a line of over 100 columns", path.display());
        let old = RENAMED.iter().map(|parts| parts.concat()).find(|word| text.contains(word));
        assert_eq!(old, None, "{} has a word that was renamed", path.display());
    }
}

/// Adds every file of code below a folder.
fn add_code(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            add_code(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs" || extension == "wgsl") {
            files.push(path);
        }
    }
}

/// The formatter leaves comments and strings as they are.
#[test]
fn lines_of_code_have_at_most_120_columns_and_the_words_of_today() {
    let mut files = Vec::new();
    for folder in ["bake", "runtime", "shaders", "tests", "assets"] {
        add_code(&Path::new(ROOT).join(folder), &mut files);
    }
    assert!(files.len() > 300, "only {} files were found", files.len());
    for path in files {
        let text = read(&path);
        let wide = text.lines().find(|line| line.chars().count() > 120);
        assert_eq!(wide, None, "{} has a line of over 120 columns", path.display());
        let old = RENAMED.iter().map(|parts| parts.concat()).find(|word| text.contains(word));
        assert_eq!(old, None, "{} has a word that was renamed", path.display());
    }
}

#[test]
fn the_format_and_the_code_for_engines_are_those_of_the_sources() {
    let [format, engine] = ["format.md", "engine.md"].map(|name| read(Path::new(ROOT).join("docs").join(name)));
    let manifest = read(Path::new(ROOT).join("bake/src/disk/manifest.rs"));
    let fields = manifest.lines().filter_map(|line| line.strip_prefix("    pub ")?.split_once(": "));
    fields.for_each(|(field, _)| assert!(format.contains(&format!("`{field}`")), "format.md lacks {field}"));
    for file in ["soft_visibility.wgsl", "soft_visibility.glsl"] {
        let code = read(Path::new(ROOT).join("shaders/src/engine").join(file));
        let code: Vec<&str> = code.lines().skip_while(|line| line.starts_with("//")).collect();
        assert!(engine.contains(&code.join("\n")), "engine.md differs from {file}");
    }
}
