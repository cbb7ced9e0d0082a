//! Jobs in G-code (RS274/NGC, as LinuxCNC, Grbl and Maslow read it): moves and arcs with feed rates become the columns
//! of a path of moves.
//!
//! Followed are G0 to G3 with I, J, K or R, G17 to G19, G20, G21, G90, G91, G90.1, G91.1 and F; words of spindle,
//! coolant and tool are passed over and counted. Any other word is refused with its line.

mod arcs;
mod words;

use crate::measurements::check_size;
use crate::number_table::NumberTable;
use anyhow::{Result, anyhow, bail};
use std::collections::BTreeMap;
use words::{Block, block};

/// Endings of the names of files that are jobs in G-code.
const ENDINGS: [&str; 7] = ["nc", "gcode", "ngc", "tap", "gco", "cnc", "g"];

/// Columns of a path of moves: where each ends in the frame of the job, its feed rate (0 for a rapid move), and for
/// arcs the centre and the angle about each axis.
pub const COLUMNS: [&str; 10] = [
    "job_x_m",
    "job_y_m",
    "job_z_m",
    "feed_m_s",
    "center_x_m",
    "center_y_m",
    "center_z_m",
    "turn_x_deg",
    "turn_y_deg",
    "turn_z_deg",
];

/// Maximum number of moves of a job: the statics of a path is computed at some fifty times of each.
const MAX_MOVES: usize = 20_000;

/// Names of axes, and of the offsets of a centre.
const AXES: [char; 3] = ['X', 'Y', 'Z'];
const OFFSETS: [char; 3] = ['I', 'J', 'K'];

/// True for the name of a file that holds G-code.
pub fn is_gcode(path: &str) -> bool {
    let ending = path.rsplit_once('.').map_or("", |(_, ending)| ending);
    ENDINGS.iter().any(|known| ending.eq_ignore_ascii_case(known))
}

/// Reads a job. The job begins at its zero.
///
/// # Errors
/// A word that cannot be followed, a number that is none, an arc that does not close, or no moves; the message names
/// the line.
///
/// # Example
/// ```
/// let job = funicular_formats::gcode::read("job.nc", b"G21 G90\nG0 X100\nG1 Y50 F600\n")?;
/// assert_eq!(job.columns["job_x_m"], [0.0, 0.1, 0.1]);
/// assert_eq!(job.columns["feed_m_s"], [0.0, 0.0, 0.01]);
/// # Ok::<(), anyhow::Error>(())
/// ```
pub fn read(path: &str, bytes: &[u8]) -> Result<NumberTable> {
    check_size(path, bytes.len())?;
    let text = std::str::from_utf8(bytes)
        .map_err(|_| anyhow!("{path}: the text is not valid UTF-8: save the job as plain text"))?;
    let mut job = Interpreter::default();
    for (number, line) in (1..).zip(text.trim_start_matches('\u{feff}').lines()) {
        job.line = number;
        let of_line = |reason: String| anyhow!("{path}, line {number}: {reason}");
        let block = block(line).map_err(of_line)?;
        job.follow(&block).map_err(of_line)?;
        if job.has_ended {
            break;
        }
        if job.lines.len() > MAX_MOVES {
            bail!("{path}, line {number}: the job has more than {MAX_MOVES} moves: split it, or simplify its curves");
        }
    }
    if job.lines.is_empty() {
        bail!("{path} has no moves: a job in G-code has lines such as `G1 X10 Y5 F600`");
    }
    Ok(job.table())
}

/// Motion of a line and of those after it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Motion {
    Rapid,
    Feed,
    Clockwise,
    Counterclockwise,
}

/// State of the interpreter; lengths in metres.
#[expect(clippy::struct_excessive_bools, reason = "modes of the language, each on or off")]
struct Interpreter {
    line: usize,
    metres: f64,
    has_units: bool,
    is_absolute: bool,
    are_centers_absolute: bool,
    motion: Option<Motion>,
    /// Index of the axis of arcs: 2 for G17.
    axis: usize,
    position: [f64; 3],
    /// Feed rate [m/s].
    feed: Option<f64>,
    rows: Vec<[f64; 10]>,
    lines: Vec<usize>,
    /// Words that are passed over, with their number.
    passed: BTreeMap<String, usize>,
    has_ended: bool,
}

impl Default for Interpreter {
    fn default() -> Self {
        Self {
            line: 0,
            metres: 1e-3,
            has_units: false,
            is_absolute: true,
            are_centers_absolute: false,
            motion: None,
            axis: 2,
            position: [0.0; 3],
            feed: None,
            rows: vec![[0.0; 10]],
            lines: Vec::new(),
            passed: BTreeMap::new(),
            has_ended: false,
        }
    }
}

impl Interpreter {
    /// Follows the words of a line.
    fn follow(&mut self, block: &Block) -> Result<(), String> {
        let mut motions = Vec::new();
        for code in &block.g {
            match code {
                0 => motions.push(Motion::Rapid),
                10 => motions.push(Motion::Feed),
                20 => motions.push(Motion::Clockwise),
                30 => motions.push(Motion::Counterclockwise),
                170 => self.axis = 2,
                180 => self.axis = 1,
                190 => self.axis = 0,
                200 | 210 => {
                    self.metres = if *code == 200 { 0.0254 } else { 1e-3 };
                    self.has_units = true;
                }
                900 => self.is_absolute = true,
                910 => self.is_absolute = false,
                901 => self.are_centers_absolute = true,
                911 => self.are_centers_absolute = false,
                // Dwell, cancelled corrections, first coordinate system, path modes, units per minute.
                40 | 400 | 490 | 540 | 610 | 611 | 640 | 800 | 940 => self.pass(format!("G{}", words::shown(*code))),
                other => {
                    return Err(format!(
                        "`G{}` cannot be followed: a job has G0 to G3, G17 to G21, G90 and G91; write what it does \
                         with them, or leave it out",
                        words::shown(*other)
                    ));
                }
            }
        }
        if motions.len() > 1 {
            return Err("there are two motions in one line: give each its own".to_owned());
        }
        self.motion = motions.first().copied().or(self.motion);
        self.other_words(block)?;
        if let Some(feed) = block.value('F') {
            if feed <= 0.0 {
                return Err(format!("the feed rate F{feed} is not positive"));
            }
            self.feed = Some(feed * self.metres / 60.0);
        }

        let moves = AXES.iter().chain(&OFFSETS).any(|axis| block.value(*axis).is_some());
        if block.g.contains(&40) || !moves {
            return Ok(());
        }
        self.moved(block)
    }

    /// Words that do not move the platform.
    fn other_words(&mut self, block: &Block) -> Result<(), String> {
        for code in &block.m {
            match code {
                20 | 300 => self.has_ended = true,
                // Stops, spindle, tool, coolant and fans, feed overrides, motors, servo of a pen.
                0 | 10 | 30..=90 | 480 | 490 | 840 | 1060 | 1070 | 2800 => {
                    self.pass(format!("M{}", words::shown(*code)));
                }
                other => {
                    return Err(format!(
                        "`M{}` cannot be followed: leave it out if it does not move the platform",
                        words::shown(*other)
                    ));
                }
            }
        }
        for letter in ['S', 'T', 'H', 'D', 'E'] {
            if block.value(letter).is_some() {
                self.pass(letter.to_string());
            }
        }
        Ok(())
    }

    fn pass(&mut self, word: String) {
        *self.passed.entry(word).or_default() += 1;
    }

    /// Move or arc of a line.
    fn moved(&mut self, block: &Block) -> Result<(), String> {
        let Some(motion) = self.motion else {
            return Err("coordinates without a motion: write G0, G1, G2 or G3 before them".to_owned());
        };
        let mut end = self.position;
        for (value, axis) in end.iter_mut().zip(AXES) {
            if let Some(given) = block.value(axis) {
                *value = given * self.metres + if self.is_absolute { 0.0 } else { *value };
            }
        }
        let feed = match (motion, self.feed) {
            (Motion::Rapid, _) => 0.0,
            (_, Some(feed)) => feed,
            (_, None) => return Err("there is no feed rate: write F, in units per minute, at or before it".to_owned()),
        };

        let mut row = [end[0], end[1], end[2], feed, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let is_arc = matches!(motion, Motion::Clockwise | Motion::Counterclockwise);
        if is_arc {
            let (center, angle) = self.arc(block, end, motion)?;
            row[4..7].copy_from_slice(&center);
            row[7 + self.axis] = angle.to_degrees();
        } else if OFFSETS.iter().any(|offset| block.value(*offset).is_some()) || block.value('R').is_some() {
            return Err("I, J, K and R belong to an arc: write G2 or G3".to_owned());
        }
        let moves = end.iter().zip(&self.position).any(|(end, start)| (end - start).abs() > 0.0);
        if is_arc || moves {
            self.rows.push(row);
            self.lines.push(self.line);
        }
        self.position = end;
        Ok(())
    }

    fn table(self) -> NumberTable {
        let columns = COLUMNS.iter().enumerate();
        let mut notes = Vec::new();
        if !self.has_units {
            notes.push("the job says neither G20 nor G21: its lengths are taken as millimetres".to_owned());
        }
        if !self.passed.is_empty() {
            let told: Vec<String> = self.passed.iter().map(|(word, count)| format!("{word} ({count})")).collect();
            notes.push(format!("words that do not move the platform are passed over: {}", told.join(", ")));
        }
        let first = self.lines.first().copied().unwrap_or(1);
        NumberTable {
            columns: columns
                .map(|(k, name)| ((*name).to_owned(), self.rows.iter().map(|row| row[k]).collect()))
                .collect(),
            lines: std::iter::once(first).chain(self.lines).collect(),
            notes,
        }
    }
}
