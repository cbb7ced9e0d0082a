//! Pages of a summary as drawings: texts in lines, a table and figures one below the other.

use super::parts::Parts;
use crate::figures::Figure;
use crate::figures::Size;
use crate::figures::drawing::{Align, BLACK, Colour, Drawing, Item, Label, Stroke};
use crate::figures::style::{AXIS_WIDTH, BLUE, GREEN, GREY, VERMILION};
use funicular_study::analyses::winches::WinchRow;
use funicular_study::columns::Style;

/// Sides of A4 [pt], and the margin.
const WIDTH: f64 = 595.28;
const HEIGHT: f64 = 841.89;
const MARGIN: f64 = 48.0;

/// Sizes of the texts [pt] that are tried from the first on until everything is on its page.
const SIZES: [f64; 6] = [9.5, 8.5, 7.5, 6.5, 5.5, 4.5];

/// Points per millimetre.
const POINTS: f64 = 72.0 / 25.4;

/// Room below a figure [pt].
const GAP: f64 = 14.0;

/// Page that is filled from the top.
struct Sheet<'a> {
    drawing: Drawing,
    y: f64,
    size: f64,
    word: &'a dyn Fn(&str) -> String,
}

/// Two pages. Texts become smaller until each page has its parts.
pub(super) fn pages(parts: &Parts, call: &str, word: &dyn Fn(&str) -> String) -> Vec<Drawing> {
    vec![fitting(&|size| first(parts, size, word)), fitting(&|size| second(parts, call, size, word))]
}

/// Page with the largest texts with which its parts end on it.
fn fitting<'a>(make: &dyn Fn(f64) -> Sheet<'a>) -> Drawing {
    let mut sheet = make(SIZES[0]);
    for size in &SIZES[1..] {
        if sheet.y <= HEIGHT - MARGIN {
            break;
        }
        sheet = make(*size);
    }
    sheet.drawing
}

/// Loads and the places where they are carried.
fn first<'a>(parts: &Parts, size: f64, word: &'a dyn Fn(&str) -> String) -> Sheet<'a> {
    let mut sheet = Sheet::new(&parts.robot, size, word);
    sheet.title(&parts.robot);
    sheet.paragraph(&parts.about, GREY);
    let (good, lines) = &parts.verdict;
    sheet.heading("What it carries");
    for line in lines {
        sheet.paragraph(line, if *good { GREEN } else { VERMILION });
    }
    sheet.heading("The robot");
    sheet.figure(&parts.picture, 118.0);
    sheet.heading("Where it works");
    sheet.paragraph(&parts.section_about, BLACK);
    match &parts.section {
        Ok(figure) => sheet.figure(figure, 110.0),
        Err(reason) => sheet.paragraph(&format!("Not shown: {reason}"), VERMILION),
    }
    sheet
}

/// Needs, dangers, and what was assumed.
fn second<'a>(parts: &Parts, call: &str, size: f64, word: &'a dyn Fn(&str) -> String) -> Sheet<'a> {
    let mut sheet = Sheet::new(&parts.robot, size, word);
    sheet.heading("What it needs: winches");
    match &parts.winches {
        Ok(found) => {
            sheet.paragraph(&format!("{}.", found.sentence()), BLACK);
            let columns = WinchRow::columns();
            let heads = columns.headings(Style::Typeset);
            let heads: Vec<String> = heads.iter().map(|of| with_unit_in_brackets(of.name, of.unit)).collect();
            let rows: Vec<Vec<String>> = found.winches.iter().map(|row| columns.texts(row, Style::Typeset)).collect();
            sheet.table(&heads, &rows);
        }
        Err(reason) => sheet.paragraph(&format!("Not computed: {reason}"), VERMILION),
    }
    for (title, text) in &parts.answers {
        sheet.heading(title);
        sheet.paragraph(&sentence(text), BLACK);
    }
    sheet.heading("Dangers");
    for text in &parts.dangers {
        sheet.paragraph(&format!("• {}", sentence(text)), BLACK);
    }
    sheet.heading("What was assumed");
    for text in &parts.assumed {
        sheet.paragraph(&format!("• {text}"), BLACK);
    }
    sheet.heading("How to repeat");
    sheet.paragraph(call, GREY);
    sheet
}

fn with_unit_in_brackets(name: &str, unit: &str) -> String {
    if unit.is_empty() { name.to_owned() } else { format!("{name} [{unit}]") }
}

/// Sentence with a capital first letter and a full stop.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    format!("{first}{}.", letters.as_str().trim_end_matches('.'))
}

impl<'a> Sheet<'a> {
    fn new(title: &str, size: f64, word: &'a dyn Fn(&str) -> String) -> Self {
        let mut drawing = Drawing::new(title, WIDTH);
        drawing.height = HEIGHT;
        Self { drawing, y: MARGIN, size, word }
    }

    fn title(&mut self, text: &str) {
        let label = Label::plain(text);
        let size = self.drawing.fitting(&label, 2.0 * self.size, WIDTH - 2.0 * MARGIN);
        self.y += 1.4 * self.size;
        self.drawing.text(label, [MARGIN, self.y], Align::Start, size, BLACK);
        self.y += 1.2 * self.size;
    }

    fn heading(&mut self, text: &str) {
        self.y += 1.9 * self.size;
        self.drawing.text(Label::plain(text), [MARGIN, self.y], Align::Start, 1.3 * self.size, BLUE);
        self.y += 0.45 * self.size;
        self.drawing.line(vec![[MARGIN, self.y], [WIDTH - MARGIN, self.y]], Stroke::solid(GREY, AXIS_WIDTH));
        self.y += 0.5 * self.size;
    }

    /// Words in as many lines as they need.
    fn paragraph(&mut self, text: &str, colour: Colour) {
        let room = WIDTH - 2.0 * MARGIN;
        let text = (self.word)(text).replace('`', "");
        let mut line = String::new();
        for word in text.split_whitespace() {
            let longer = if line.is_empty() { word.to_owned() } else { format!("{line} {word}") };
            if !line.is_empty() && self.drawing.width_of(&Label::plain(&longer), self.size) > room {
                self.line(&line, colour);
                word.clone_into(&mut line);
            } else {
                line = longer;
            }
        }
        if !line.is_empty() {
            self.line(&line, colour);
        }
        self.y += 0.25 * self.size;
    }

    fn line(&mut self, text: &str, colour: Colour) {
        self.y += 1.25 * self.size;
        let label = Label::plain(text);
        // A single word may be longer than a line.
        let size = self.drawing.fitting(&label, self.size, WIDTH - 2.0 * MARGIN);
        self.drawing.text(label, [MARGIN, self.y], Align::Start, size, colour);
    }

    /// Table with numbers aligned to the right; it becomes smaller until its columns have room.
    fn table(&mut self, headings: &[String], rows: &[Vec<String>]) {
        let room = WIDTH - 2.0 * MARGIN;
        let widths = |drawing: &Drawing, size: f64| -> Vec<f64> {
            let cell = |k: usize| rows.iter().map(move |row| row[k].as_str());
            let column = |k: usize| {
                let texts = cell(k).chain([headings[k].as_str()]);
                texts.map(|text| drawing.width_of(&Label::plain(text), size)).fold(0.0, f64::max) + 0.9 * size
            };
            (0..headings.len()).map(column).collect()
        };
        let wide: f64 = widths(&self.drawing, self.size).iter().sum();
        let size = self.size * (room / wide).min(1.0);
        let widths = widths(&self.drawing, size);
        for (number, row) in std::iter::once(headings).chain(rows.iter().map(Vec::as_slice)).enumerate() {
            self.y += 1.35 * size;
            let mut right = MARGIN;
            for (k, (cell, width)) in row.iter().zip(&widths).enumerate() {
                right += width;
                let (at, align) = if k == 0 { (right - width, Align::Start) } else { (right - 0.2 * size, Align::End) };
                self.drawing.text(Label::plain(cell), [at, self.y], align, size, BLACK);
            }
            if number == 0 {
                self.y += 0.4 * size;
                self.drawing.line(vec![[MARGIN, self.y], [right, self.y]], Stroke::solid(BLACK, AXIS_WIDTH));
            }
        }
        self.y += 0.5 * size;
    }

    /// Figure with a width [mm] in the middle, at most as high as two fifths of the page.
    fn figure(&mut self, figure: &Figure, width_mm: f64) {
        let mut width_mm = width_mm;
        let mut drawn = figure.draw(Size::of_page(width_mm));
        let most = 0.38 * HEIGHT;
        if drawn.height > most {
            width_mm *= most / drawn.height;
            drawn = figure.draw(Size::of_page(width_mm));
        }
        self.y += 0.4 * self.size;
        let shift = [0.5 * (WIDTH - width_mm * POINTS), self.y];
        let moved = |point: &mut [f64; 2]| *point = [point[0] + shift[0], point[1] + shift[1]];
        for mut item in drawn.items {
            match &mut item {
                Item::Path(path) => path.lines.iter_mut().flatten().for_each(moved),
                Item::Text(text) => moved(&mut text.at),
                // Nothing moves on paper.
                Item::Moving(_) => continue,
            }
            self.drawing.items.push(item);
        }
        self.y += drawn.height + GAP;
    }
}
