//! `HARD_CASES.md` says what is true: every test that it links exists and names its code, and every code without a
//! test stands under "Open".

use std::collections::BTreeSet;
use std::path::Path;

/// What a document says of one code.
#[derive(Debug, Default, PartialEq)]
struct Case {
    code: String,
    /// Whether it stands under "Open".
    is_open: bool,
    /// Linked tests: the function's name and its file.
    tests: Vec<[String; 2]>,
}

/// A line `**B1.** ...` begins a case. A line ``- [`name`](file)`` below it links a test.
fn cases(document: &str) -> Vec<Case> {
    let mut cases: Vec<Case> = Vec::new();
    let mut is_open = false;
    for line in document.lines() {
        if let Some(title) = line.strip_prefix("## ") {
            is_open = title == "Open";
        } else if let Some((code, _)) = line.strip_prefix("**").and_then(|rest| rest.split_once(".**")) {
            cases.push(Case { code: code.into(), is_open, tests: Vec::new() });
        } else if let Some((name, rest)) = line.strip_prefix("- [`").and_then(|rest| rest.split_once("`](")) {
            let file = rest.strip_suffix(')').unwrap_or_else(|| panic!("a link without an end: {line}"));
            let case = cases.last_mut().unwrap_or_else(|| panic!("a link before the first case: {line}"));
            case.tests.push([name.into(), file.into()]);
        }
    }
    cases
}

/// What is wrong with a document; `read` gives the text of a file that it links.
fn problems(document: &str, read: impl Fn(&str) -> Option<String>) -> Vec<String> {
    let mut problems = Vec::new();
    let mut tested = BTreeSet::new();
    for Case { code, is_open, tests } in cases(document) {
        match (is_open, tests.is_empty()) {
            (false, true) => problems.push(format!("{code} has no test and is not under Open")),
            (true, false) => problems.push(format!("{code} has a test and is under Open")),
            (true, true) => {}
            (false, false) if !tested.insert(code.clone()) => problems.push(format!("{code} is there twice")),
            (false, false) => {}
        }
        for [name, file] in tests {
            match read(&file).map(|text| docs_of(&text, &name)) {
                None => problems.push(format!("{code}: there is no {file}")),
                Some(None) => problems.push(format!("{code}: there is no {name} in {file}")),
                Some(Some(docs)) if !is_named(&code, &name, &docs) => {
                    problems.push(format!("{name} in {file} does not name {code}"));
                }
                Some(Some(_)) => {}
            }
        }
    }
    problems
}

/// The doc comment of a function, if a file has that function.
fn docs_of(text: &str, function: &str) -> Option<String> {
    let lines: Vec<&str> = text.lines().map(str::trim_start).collect();
    let start = format!("fn {function}(");
    let found = lines.iter().position(|line| line.starts_with(&start))?;
    let above = lines[..found].iter().rev();
    Some(above.take_while(|line| line.starts_with("///") || line.starts_with("#[")).copied().collect())
}

fn is_named(code: &str, name: &str, docs: &str) -> bool {
    let is_word = |text: &str| text.split(|c: char| !c.is_ascii_alphanumeric()).any(|word| word == code);
    name.starts_with(&format!("{}_", code.to_lowercase())) || is_word(docs)
}

#[test]
fn every_code_has_its_tests_or_is_open() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let document = std::fs::read_to_string(folder.join("HARD_CASES.md")).expect("it lies beside the tests");
    let found = problems(&document, |file| std::fs::read_to_string(folder.join(file)).ok());
    assert!(found.is_empty(), "{}", found.join("\n"));
    let cases = cases(&document);
    assert!(cases.iter().filter(|case| !case.is_open).count() > 50, "{} cases were read", cases.len());
}

#[test]
fn what_is_missing_from_the_document_or_the_tests_is_found() {
    let source = "/// B1 and B2: a claim.\n#[test]\nfn a_claim() {}\n#[test]\nfn b3_another() {}\n";
    let read = |file: &str| (file == "a.rs").then(|| source.to_owned());
    let sound = "**B1.** One.\n- [`a_claim`](a.rs)\n**B2.** Two.\n- [`a_claim`](a.rs)\n**B3.** Three.\n\
                 - [`b3_another`](a.rs)\n## Open\n**B4.** Four.\n";
    assert_eq!(problems(sound, read), [""; 0]);
    for (from, to, problem) in [
        ("[`a_claim`](a.rs)\n**B2", "[`a_claim`](b.rs)\n**B2", "B1: there is no b.rs"),
        ("- [`a_claim`](a.rs)\n**B2", "**B2", "B1 has no test and is not under Open"),
        ("`b3_another`", "`b3_other`", "B3: there is no b3_other in a.rs"),
        ("**B3.**", "**B5.**", "b3_another in a.rs does not name B5"),
        ("**B3.** Three.", "**B3.** Three.\n- [`a_claim`](a.rs)", "a_claim in a.rs does not name B3"),
        ("Four.\n", "Four.\n- [`a_claim`](a.rs)\n", "B4 has a test and is under Open"),
    ] {
        let broken = sound.replace(from, to);
        assert!(
            problems(&broken, read).iter().any(|found| found == problem),
            "{problem}: {:?}",
            problems(&broken, read)
        );
    }
}
