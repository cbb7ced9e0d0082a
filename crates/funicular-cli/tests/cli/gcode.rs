//! Jobs in G-code as paths, against a plain interpreter of its own, and belts that go slack under lengths alone.

use super::{json, number, numbers, robot, run, stderr, stdout, succeed};
use serde_json::Value;
use std::fs;

const COURSE: [&str; 6] = ["--speed-m-s", "0.2", "--acceleration-m-s2", "1", "--jerk-m-s3", "20"];

/// Keeps a file in a folder for the time of a test.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn file(&self, name: &str, text: &str) -> String {
        let path = self.0.path().join(name);
        fs::write(&path, text).unwrap();
        path.display().to_string()
    }
}

/// Points along the moves of a job [mm], a hundredth of each apart, with the feed rate [mm/min] of the move; infinite
/// for rapid moves. Reads one word after the other, and turns about a centre in small steps.
fn plain(job: &str) -> Vec<([f64; 2], f64)> {
    let (mut at, mut unit, mut feed, mut motion, mut relative) = ([0.0, 0.0], 1.0, 0.0, 0, false);
    let mut points = vec![(at, f64::INFINITY)];
    for line in job.lines() {
        let line = line.split([';', '(']).next().unwrap();
        let words: Vec<(char, f64)> =
            line.split_whitespace().map(|word| (word.chars().next().unwrap(), word[1..].parse().unwrap())).collect();
        for (letter, value) in &words {
            match (letter, *value as i32) {
                ('G', 0..=3) => motion = *value as i32,
                ('G', 20) => unit = 25.4,
                ('G', 21) => unit = 1.0,
                ('G', 90) => relative = false,
                ('G', 91) => relative = true,
                _ => {}
            }
        }
        let word = |letter: char| words.iter().find(|word| word.0 == letter).map(|word| word.1 * unit);
        feed = word('F').unwrap_or(feed);
        let Some(_) = word('X').or(word('Y')) else { continue };
        let target =
            |k: usize, letter: char| word(letter).map_or(at[k], |value| if relative { at[k] + value } else { value });
        let end = [target(0, 'X'), target(1, 'Y')];
        let speed = if motion == 0 { f64::INFINITY } else { feed };
        if motion < 2 {
            for k in 1..=100 {
                let part = f64::from(k) / 100.0;
                points.push(([0, 1].map(|i| at[i] + part * (end[i] - at[i])), speed));
            }
        } else {
            let turn = if motion == 2 { -1.0 } else { 1.0 };
            let (center, angle) = word('R').map_or_else(
                || {
                    let center = [at[0] + word('I').unwrap_or(0.0), at[1] + word('J').unwrap_or(0.0)];
                    (center, swept(at, end, center, turn))
                },
                |radius| of_radius(at, end, radius, turn),
            );
            for k in 1..=100 {
                let by = turn * angle * f64::from(k) / 100.0;
                let [x, y] = [at[0] - center[0], at[1] - center[1]];
                let turned = [x * by.cos() - y * by.sin(), x * by.sin() + y * by.cos()];
                points.push(([center[0] + turned[0], center[1] + turned[1]], speed));
            }
        }
        at = end;
    }
    points
}

/// Angle by which an arc turns in its direction, up to a whole turn.
fn swept(from: [f64; 2], to: [f64; 2], center: [f64; 2], turn: f64) -> f64 {
    let angle = |point: [f64; 2]| (point[1] - center[1]).atan2(point[0] - center[0]);
    let by = turn * (angle(to) - angle(from));
    let by = if by < 1e-9 { by + std::f64::consts::TAU } else { by };
    if by < 1e-9 { by + std::f64::consts::TAU } else { by }
}

/// Centre and angle of an arc with a radius: of both circles through the ends, that whose arc is short for a positive
/// radius and long for a negative one.
fn of_radius(from: [f64; 2], to: [f64; 2], radius: f64, turn: f64) -> ([f64; 2], f64) {
    let half = [0.5 * (to[0] - from[0]), 0.5 * (to[1] - from[1])];
    let chord = half[0].hypot(half[1]);
    let height = (radius * radius - chord * chord).max(0.0).sqrt() / chord;
    let centers = [1.0, -1.0]
        .map(|side| [from[0] + half[0] - side * height * half[1], from[1] + half[1] + side * height * half[0]]);
    let arcs = centers.map(|center| (center, swept(from, to, center, turn)));
    let is_short = |arc: &([f64; 2], f64)| arc.1 <= std::f64::consts::PI + 1e-9;
    arcs.into_iter().find(|arc| is_short(arc) == (radius > 0.0)).unwrap()
}

/// Distance of a point from a line of points.
fn distance(point: [f64; 2], line: &[([f64; 2], f64)]) -> f64 {
    line.windows(2)
        .map(|pair| {
            let (a, b) = (pair[0].0, pair[1].0);
            let (way, to) = ([b[0] - a[0], b[1] - a[1]], [point[0] - a[0], point[1] - a[1]]);
            let square = way[0] * way[0] + way[1] * way[1];
            let part = if square > 0.0 { ((way[0] * to[0] + way[1] * to[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
            (to[0] - part * way[0]).hypot(to[1] - part * way[1])
        })
        .fold(f64::INFINITY, f64::min)
}

/// Position of a row in the frame of the job [mm].
fn place(row: &Value) -> [f64; 2] {
    let position = numbers(&row["position_m"]);
    [1e3 * (position[0] - 2.2), 1e3 * (position[1] - 1.8)]
}

fn trajectory(job: &str, more: &[&str]) -> Value {
    let wall = robot("wall-machine.toml");
    json(&[&["trajectory", &wall, "--path", job, "--path-origin-m", "2.2,1.8,0"], &COURSE[..], more].concat())
}

#[test]
fn a_job_is_followed_as_a_plain_interpreter_reads_it() {
    let folder = Folder::new();
    for job in [
        "G21 G90\nG0 X100 Y0\nG1 X300 F1500\nG3 X400 Y100 I0 J100\nG1 Y200\nG2 X300 Y300 R-100\nG0 X0 Y0\n",
        "G20 G91 ; inches, relative\nG1 X4 Y1 F60\nG2 X2 Y2 R3 (short arc)\n\
         G2 X0 Y0 I2 J0\nG1 X-3\nG0 Y-2\nG3 X1 Y1 R-2.5\n",
    ] {
        let path = folder.file("job.nc", &format!("%\n{job}M30\n"));
        let found = trajectory(&path, &["--sample-time-s", "0.05"]);
        let line = plain(job);
        let rows = found["rows"].as_array().unwrap();

        // A chord of a hundredth of an arc of 102 mm leaves it by 102 (1 − cos 0.0315) = 0.05 mm.
        let off = rows.iter().map(|row| distance(place(row), &line)).fold(0.0, f64::max);
        assert!(off < 0.06, "{job}: {off}");
        // The path passes all ends of moves, and ends at the last.
        for end in line.iter().skip(100).step_by(100) {
            let nearest = rows.iter().map(|row| {
                let at = place(row);
                (at[0] - end.0[0]).hypot(at[1] - end.0[1])
            });
            assert!(nearest.fold(f64::INFINITY, f64::min) < 2.0, "{job}");
        }
        let last = place(rows.last().unwrap());
        let end = line.last().unwrap().0;
        assert!((last[0] - end[0]).hypot(last[1] - end[1]) < 1e-6, "{job}: {last:?} {end:?}");

        // The time is not below that of the feed rates, and little above it: every move speeds up and slows down.
        let length = |pair: &[([f64; 2], f64)]| (pair[1].0[0] - pair[0].0[0]).hypot(pair[1].0[1] - pair[0].0[1]);
        let least: f64 = line.windows(2).map(|pair| length(pair) / (pair[1].1 / 60.0).min(200.0)).sum();
        let duration = number(&found["duration_s"]);
        assert!(duration > least && duration < least + 7.0 * 0.5, "{job}: {duration} {least}");
    }
}

#[test]
fn what_cannot_be_followed_is_refused_with_its_line_and_what_is_passed_over_is_told() {
    let folder = Folder::new();
    let wall = robot("wall-machine.toml");
    for (job, says) in [
        ("G21\nG1 X10", "line 2: there is no feed rate"),
        ("G21\nX10", "line 2: coordinates without a motion"),
        ("G1 X1 F100\nG33 Z1", "line 2: `G33` cannot be followed"),
        ("G1 X1 F100\n\nG92 X0", "line 3: `G92`"),
        ("G1 X1 F100\nM98 P1", "line 2: `M98`"),
        ("G1 X1 A3 F100", "line 1: `A3` cannot be followed"),
        ("G1 X#1 F100", "line 1:"),
        ("G2 X10 F100", "line 1: an arc needs its centre"),
        ("G2 X10 I3 J1 F100", "line 1: the arc does not close"),
        ("G2 X10 R4 F100", "does not reach its end"),
        ("G2 R4 F100 I1 X2", "not both"),
        ("G1 X10 (open F100", "a comment has no end"),
        ("M3\n", "has no moves"),
    ] {
        let path = folder.file("job.NC", job);
        let refused = run(&[&["trajectory", &wall, "--path", &path], &COURSE[..]].concat());
        assert_eq!(refused.status.code(), Some(2), "{job}: {}", stdout(&refused));
        assert!(stderr(&refused).contains(says), "{job}: {}", stderr(&refused));
    }

    let path = folder.file("job.gcode", "N1 g1x10y5f600 S100 M3\nM8\nG0 Z5\nM3 ; again\n");
    let origin = ["--path-origin-m", "2.2,1.8,0"];
    let told = run(&[&["trajectory", &wall, "--path", &path], &origin[..], &COURSE].concat());
    assert_eq!(told.status.code(), Some(0), "{}", stderr(&told));
    assert!(stderr(&told).contains("passed over: M3 (2), M8 (1), S (1)"), "{}", stderr(&told));
    assert!(stderr(&told).contains("taken as millimetres"), "{}", stderr(&told));

    // A job has no times of its own.
    let settle = run(&["settle", &wall, "--trajectory", &path]);
    assert!(stderr(&settle).contains("a job has no times"), "{}", stderr(&settle));
}

#[test]
fn a_table_with_feed_rates_is_a_job_too() {
    let folder = Folder::new();
    let table = folder.file("job.csv", "x_m,y_m,z_m,feed_in_min\n2.2,1.8,0,0\n2.4,1.8,0,60\n2.4,2.0,0,0\n");
    let found = json(&[&["trajectory", &robot("wall-machine.toml"), "--path", &table], &COURSE[..]].concat());
    // 0.2 m at 0.0254 m/s and at 0.2 m/s, and the time of speeding up at 1 m/s² and 20 m/s³.
    let duration = number(&found["duration_s"]);
    let least = 0.2 / 0.0254 + 0.2 / 0.2;
    assert!(duration > least && duration < least + 0.7, "{duration} {least}");
}

/// Machine with massless belts under 45° in a square of 4 m, its belts at one height and crossed.
fn square() -> String {
    let text = fs::read_to_string(robot("wall-machine.toml")).unwrap();
    let mut text = text.replace("mass_kg_per_m = 0.03 ", "mass_kg_per_m = 0.0 ");
    for (old, new) in [
        ("[4.6546, 0.0, 0.02]", "[4.0, 0.0, 0.02]"),
        ("[4.6291, 3.8549, 0.04]", "[4.0, 4.0, 0.04]"),
        ("[-0.1671, 3.8974, 0.06]", "[0.0, 4.0, 0.06]"),
        ("[2.25, 2.0, 0.0]", "[2.0, 2.0, 0.0]"),
    ] {
        assert!(text.contains(old));
        text = text.replace(old, new);
    }
    text
}

#[test]
fn belts_go_slack_under_geometric_lengths_where_the_load_hangs_on_two_of_them() {
    let folder = Folder::new();
    let machine = folder.file("square.toml", &square());
    let path = folder.file("way.csv", "x_m,y_m,z_m,feed_m_s\n2,2,0,0\n2,2.005,0,0.002\n");
    let slowly = ["--speed-m-s", "0.2", "--acceleration-m-s2", "0.01", "--jerk-m-s3", "20"];
    let found = json(&[&["trajectory", &machine, "--path", &path], &slowly[..]].concat());
    let commands = found["length_commands"].as_array().unwrap();
    assert_eq!((&commands[0]["lengths"], &commands[1]["lengths"]), (&"computed".into(), &"geometric".into()));
    assert!(
        commands[0]["slack"].as_array().unwrap().is_empty() && number(&commands[0]["lowest_tension_n"]) > 20.0 - 1e-9
    );

    // Two massless belts carry 86.3 N, the others are longer than their chords from the start on.
    let slack = commands[1]["slack"].as_array().unwrap();
    let names: Vec<&str> = slack.iter().map(|of| of["cable"].as_str().unwrap()).collect();
    assert_eq!((names, number(&slack[0]["t_s"])), (vec!["bl", "br"], 0.0));
    assert!(number(&commands[1]["lowest_tension_n"]).abs() < 1e-300);
    // The sled sinks by the stretch of a belt, T l/EA, over the sine of its angle, T being mg/2 over the same sine.
    let (dx, dy): (f64, f64) = (2.12, 1.94);
    let length = dx.hypot(dy);
    let sine = dy / length;
    let sinks = 8.8 * 9.81 / 2.0 / sine * length / 178.9e3 / sine;
    let moved = number(&commands[1]["displacement_m"]);
    assert!((moved / sinks - 1.0).abs() < 0.01, "{moved} {sinks}");

    let text = succeed(&[&["trajectory", &machine, "--path", &path], &slowly[..]].concat());
    assert!(text.contains("cable \"bl\" goes slack at t = 0 s"), "{text}");
    assert!(text.contains("no cable goes slack; lowest tension 20.00 N"), "{text}");

    // A robot with as many cables as degrees of freedom has no choice of tensions.
    let six = robot("yuan2014-4mm.toml");
    let plain = json(&[&["trajectory", &six, "--pose", "0,0,0.5", "--move-to", "0.1,0,0.5"], &COURSE[..]].concat());
    assert!(plain.get("length_commands").is_none());
}
