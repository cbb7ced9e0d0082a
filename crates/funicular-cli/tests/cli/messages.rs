//! Text of the user in messages: nothing acts on a terminal, and no message is as long as its input.

use super::{run, run_with, stderr, stdout, yuan};
use std::fs;

/// Maximum length of a message [bytes]; two lines of it may be cut.
const MAX_MESSAGE: usize = 8000;

/// Texts that a user may have by mistake or from somebody else: colours, a title of the terminal, text that runs
/// backwards, and text without end.
fn hostile() -> [String; 4] {
    [
        "a\u{1b}[31mred\u{1b}]0;owned\u{7}".to_owned(),
        "a\u{202e}txt\u{2066}b\u{200f}\u{9b}31m".to_owned(),
        "x".repeat(100_000),
        "x ".repeat(50_000),
    ]
}

/// Asserts that a message is harmless.
fn is_harmless(message: &str, input: &str) {
    let input: String = input.chars().take(40).collect();
    let bad = message.chars().find(|c| *c != '\n' && funicular::suggest::is_hidden(*c));
    assert!(bad.is_none(), "{input}: {bad:?} in {message:?}");
    assert!(message.len() < MAX_MESSAGE, "{input}: {} bytes: {message:.2000}", message.len());
}

/// Asserts that a run is refused with a harmless message.
fn refused(arguments: &[&str]) {
    let output = run(arguments);
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{message:.2000}");
    is_harmless(message, &arguments.join(" "));
}

#[test]
fn options_with_any_text_give_harmless_messages() {
    for text in hostile() {
        for arguments in [
            &["statics", "ROBOT", "--mass-kg"][..],
            &["statics", "ROBOT", "--pose"],
            &["statics", "ROBOT", "--lengths-m"],
            &["statics", "ROBOT", "--static-model"],
            &["statics", "ROBOT", "--tension-rule"],
            &["statics", "ROBOT", "--set"],
            &["frf", "ROBOT", "--input"],
            &["frf", "ROBOT", "--input", "fz", "--output"],
            &["cable", "ROBOT", "--hz", "1", "--cable"],
            &["map", "ROBOT", "-o", "a.csv", "--grid", "x=0:1:2", "--quantity"],
            &["identify", "ROBOT", "--measured", "none.csv", "--fit"],
            &["identify", "ROBOT", "--fit", "platform.mass_kg", "--measured"],
            &["identify", "ROBOT", "--fit", "platform.mass_kg", "--measured", "none.uff", "--response"],
            &["uncertainty", "ROBOT", "--tolerance"],
            &["import"],
            &["statics"],
            &["request"],
            &["plot"],
            &["modes", "ROBOT", "--below-hz"],
            &[],
        ] {
            refused(&[arguments, &[&text]].concat());
        }
        for path in ["platform", "cables", "materials.rope-4mm"] {
            refused(&["statics", "ROBOT", "--set", &format!("{path}.{text}=1")]);
            refused(&["statics", "ROBOT", "--set", &format!("{path}={text}")]);
        }
        refused(&["statics", "ROBOT", &format!("--{text}")]);
    }
}

#[test]
fn files_with_any_text_give_harmless_messages() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let uff = include_str!("identify/frame.uff");
    let tripod = |name: &str| fs::read_to_string(super::project(&format!("docs/import/{name}"))).unwrap();

    for text in hostile() {
        // Tables.
        for table in [
            format!("frequency_hz,std_hz\n1.02,{text}\n"),
            format!("frequency_hz,{text}\n1.02,1\n"),
            format!("frequency_hz,{text}_re,{text}_im\n1.02,1,1\n"),
            format!("frequency_hz,a{text}\n1.02\n"),
            format!("{text}\n1\n"),
            format!("frequency_hz\n1\n\"2\n{text}\"\n"),
        ] {
            refused(&["identify", "ROBOT", "--fit", "platform.mass_kg", "--measured", &file("a.csv", &table)]);
        }
        for table in [format!("x_m,y_m,z_m\n0,0,{text}\n"), format!("x_m,y_m,{text}\n0,0,1\n")] {
            refused(&["map", "ROBOT", "-o", "none.csv", "--poses", &file("poses.csv", &table)]);
        }
        let many = format!("frequency_hz,{}\n1\n", (0..20_000).map(|i| format!("c{i}")).collect::<Vec<_>>().join(","));
        refused(&["identify", "ROBOT", "--fit", "platform.mass_kg", "--measured", &file("a.csv", &many)]);

        // Universal Files.
        for changed in [
            uff.replacen("Hz   ", &text, 1),
            uff.replacen("m/s^2", &text, 1),
            uff.replacen("    -1\n    58", &format!("    -1\n{text}"), 1),
            uff.replacen("NONE  ", &text, 1),
            uff.replacen(" -1.892", &text, 1),
            text.clone(),
        ] {
            refused(&["identify", "ROBOT", "--fit", "platform.mass_kg", "--measured", &file("a.uff", &changed)]);
        }

        // Robot files, and requests in JSON.
        for changed in [
            yuan().replacen("mass_kg = ", &format!("mass_kg = \"{text}\" # "), 1),
            yuan().replacen("[platform]", &format!("[platform]\n\"{text}\" = 1"), 1),
            yuan().replacen("name = ", &format!("{text} = "), 1),
            yuan().replacen("material = \"", &format!("material = \"{text}"), 1),
            text.clone(),
        ] {
            let output = run_with(&["statics", "-"], &changed);
            assert_eq!(output.status.code(), Some(2));
            is_harmless(stderr(&output), &text);
        }
        for changed in [
            serde_json::json!({ "command": text }),
            serde_json::json!({ "command": "statics", "robot": { "text": yuan() }, text.as_str(): 1 }),
            serde_json::json!({ "command": "statics", "robot": { "text": yuan() }, "tension_rule": text }),
            serde_json::json!({ "command": "frf", "robot": { "text": yuan() }, "input": text, "output": "z" }),
        ] {
            refused(&["request", &file("a.json", &changed.to_string())]);
        }

        // Files of other programs.
        for (name, from) in
            [("tripod.txt", "1e6"), ("tripod.txt", "Fixed "), ("tripod.txt", "rope  "), ("tripod.wcrfx", "3R3T")]
        {
            refused(&["import", &file(name, &tripod(name).replacen(from, &text, 1)), "-o", "none.toml"]);
        }
    }
}

#[test]
fn names_with_any_text_are_printed_harmlessly() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.csv");
    for text in hostile() {
        fs::write(&path, format!("frequency_hz,label\n1.02,1\n1.5,{text}\n")).unwrap();
        let measured = ["--measured", path.to_str().unwrap(), "--starts", "1"];
        let output = run(&[&["identify", "ROBOT", "--fit", "platform.mass_kg"], &measured[..]].concat());
        is_harmless(stderr(&output), &text);
        is_harmless(stdout(&output), &text);
    }
}
