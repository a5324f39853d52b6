//! `sunbake` and `sunplay` meet the same mistakes with the same exit code and in the same form.

use std::path::Path;
use std::process::Command;
use sunbake_tests::compared::posts;
use sunbake_tests::{built_program, stderr, write_scene};

/// A mistake, made with either command.
struct Mistake {
    name: &'static str,
    /// Arguments of `sunbake` and of `sunplay`.
    arguments: [&'static str; 2],
    code: i32,
    /// What both say.
    words: &'static [&'static str],
}

const MISTAKES: [Mistake; 21] = [
    Mistake {
        name: "an unknown command",
        arguments: ["frobnicate", "frobnicate"],
        code: 1,
        words: &["unrecognized subcommand 'frobnicate'", "--help` tells more"],
    },
    Mistake {
        name: "an unknown option",
        arguments: ["bake scene.glb -o out --fast", "frame scene.glb -o out.png --fast"],
        code: 1,
        words: &["unexpected argument '--fast'", "--help` tells more"],
    },
    Mistake {
        name: "an option that is missing",
        arguments: ["bake scene.glb", "frame scene.glb"],
        code: 1,
        words: &["required", "--help` tells more"],
    },
    Mistake {
        name: "a value that is none",
        arguments: ["bake scene.glb -o out --place Vienna", "frame scene.glb -o out.png --place Vienna"],
        code: 1,
        words: &["not a place", "48.2,16.4"],
    },
    Mistake {
        name: "more threads than are of use",
        arguments: ["bake scene.glb -o out --threads 1000000", "compare scene.glb -o out --threads 1000000"],
        code: 5,
        words: &["cannot start 1000000 threads: 1024 are the most", "give a smaller --threads"],
    },
    Mistake {
        name: "a day that does not exist",
        arguments: ["bake scene.glb -o out --date 2026-02-29", "compare scene.glb -o out --date 2026-02-29"],
        code: 1,
        words: &["2026-02-29 does not exist"],
    },
    Mistake {
        name: "a place off the globe",
        arguments: [
            "bake scene.glb -o out --place 95,0",
            "frame scene.glb -o out.png --technique truth:hard --place 95,0",
        ],
        code: 1,
        words: &["latitude 95 is off the globe", "give degrees north"],
    },
    Mistake {
        name: "an unknown material",
        arguments: ["bake scene.glb -o out --leave-out hull", "compare scene.glb -o out --leave-out hull"],
        code: 1,
        words: &["no material, node or mesh named \"hull\"", "give another --leave-out"],
    },
    Mistake {
        name: "a scene that is missing",
        arguments: ["bake nowhere.glb -o out", "frame nowhere.glb -o out.png --technique truth:hard"],
        code: 2,
        words: &["nowhere.glb", "check"],
    },
    Mistake {
        name: "a scene that cannot be read",
        arguments: ["bake loop.glb -o out", "frame loop.glb -o out.png --technique truth:hard"],
        code: 2,
        words: &["loop.glb", "check"],
    },
    Mistake {
        name: "a set that is missing",
        arguments: ["inspect nowhere", "frame nowhere -o out.png"],
        code: 2,
        words: &["nowhere is not there", "check its name"],
    },
    Mistake {
        name: "a folder that is no set",
        arguments: ["inspect folder", "frame folder -o out.png"],
        code: 2,
        words: &["folder holds no sunbake.json", "sunbake bake"],
    },
    Mistake {
        name: "a file in the way",
        arguments: ["bake scene.glb -o letter.txt/out", "compare scene.glb -o letter.txt/out"],
        code: 2,
        words: &["cannot write in letter.txt", "choose another folder with -o"],
    },
    Mistake {
        name: "a folder in the way",
        arguments: ["bake scene.glb -o folder", "compare scene.glb -o folder"],
        code: 2,
        words: &["folder exists", "never replaced", "choose another folder with -o", "remove it yourself"],
    },
    Mistake {
        name: "a file of that name",
        arguments: ["bake scene.glb -o letter.txt", "compare scene.glb -o letter.txt"],
        code: 2,
        words: &["letter.txt exists", "never replaced", "choose another folder with -o"],
    },
    Mistake {
        name: "a folder that is somebody else's",
        arguments: ["bake scene.glb -o folder --force", "compare scene.glb -o folder --force"],
        code: 2,
        words: &["never replaced", "choose another folder with -o", "remove it yourself"],
    },
    Mistake {
        name: "a scene that is none",
        arguments: ["bake letter.txt -o out", "frame letter.txt -o out.png --technique truth:hard"],
        code: 3,
        words: &["letter.txt is not a glTF scene", "export"],
    },
    Mistake {
        name: "a scene that asks for what is not supported",
        arguments: ["bake extension.gltf -o out", "frame extension.gltf -o out.png --technique truth:hard"],
        code: 3,
        words: &["ACME_x"],
    },
    Mistake {
        name: "control characters in a file",
        arguments: ["bake control.gltf -o out", "frame control.gltf -o out.png --technique truth:hard"],
        code: 3,
        words: &["ACME"],
    },
    Mistake {
        name: "a set that is damaged",
        arguments: ["inspect damaged", "frame damaged -o out.png"],
        code: 3,
        words: &["sunbake.json", "bake the scene again"],
    },
    Mistake {
        name: "a page that is too large",
        arguments: ["bake scene.glb -o out --size 16384", "compare scene.glb -o out --page-size 16384"],
        code: 3,
        words: &["16384 x 16384 texels", "MiB are allowed", "give a smaller --"],
    },
];

/// A folder with everything that the mistakes are made with.
fn work_folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name);
    write_scene(&posts(0.0), folder.path(), "scene");
    let extension = |name: &str| format!(r#"{{"asset": {{"version": "2.0"}}, "extensionsRequired": ["{name}"]}}"#);
    std::fs::write(path("extension.gltf"), extension("ACME_x")).unwrap();
    std::fs::write(path("control.gltf"), extension(r"ACME\n\u001b[31m")).unwrap();
    std::fs::write(path("letter.txt"), "dear").unwrap();
    for name in ["folder", "damaged"] {
        std::fs::create_dir(path(name)).unwrap();
    }
    std::fs::write(path("folder/letter.txt"), "dear").unwrap();
    std::fs::write(path("damaged/sunbake.json"), "{").unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink("loop.glb", path("loop.glb")).unwrap();
    folder
}

fn check(folder: &Path, command: &str, arguments: &str, mistake: &Mistake) {
    let mut run = Command::new(built_program(command));
    // Without a GPU nothing here depends on the machine.
    run.args(arguments.split(' ')).current_dir(folder);
    if command == "sunplay" && arguments.starts_with("compare") {
        run.args(["--renderer", "cpu"]);
    }
    let output = run.output().expect("the command starts");
    let (name, line) = (format!("{}: {command} {arguments}", mistake.name), stderr(&output));
    assert_eq!(output.status.code(), Some(mistake.code), "{name}: {line}");
    assert!(output.stdout.is_empty(), "{name}: it prints on stdout");
    assert!(line.starts_with(&format!("{command}: ")) && line.ends_with('\n'), "{name}: {line}");
    assert!(!line.trim_end().contains(char::is_control), "{name}: more than a plain line: {line:?}");
    for word in mistake.words {
        assert!(line.contains(word), "{name}: lacks `{word}`: {line}");
    }
    assert!(!folder.join("out").exists() && !folder.join("out.png").exists(), "{name}: it leaves something behind");
}

#[test]
fn both_commands_meet_the_same_mistakes_with_the_same_code_and_form() {
    let folder = work_folder();
    for mistake in MISTAKES {
        for (command, arguments) in ["sunbake", "sunplay"].into_iter().zip(mistake.arguments) {
            check(folder.path(), command, arguments, &mistake);
        }
    }
}
