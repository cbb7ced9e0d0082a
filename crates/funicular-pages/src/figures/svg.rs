//! Drawings as SVG.
//!
//! Texts stay texts, in the sans serif fonts that journals ask for; a program for drawings can edit them. Arial and
//! Helvetica are narrower than the font whose widths place the texts, so that no text overlaps another.

use super::drawing::{Colour, Drawing, DrawnPath, Item, Moving, PaperPoint, RAISED, Text};
use std::fmt::Write as _;

const FAMILY: &str = "Arial, Helvetica, 'Liberation Sans', 'Noto Sans', sans-serif";
/// Millimetres per point.
const MM: f64 = 25.4 / 72.0;

/// Text of the SVG file.
pub(crate) fn svg(drawing: &Drawing) -> String {
    let Drawing { width, height, .. } = *drawing;
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}mm\" height=\"{}mm\" viewBox=\"0 0 {} {}\" \
         font-family=\"{FAMILY}\" stroke-linejoin=\"round\">\n<title>{}</title>\n<rect width=\"{}\" height=\"{}\" \
         fill=\"#ffffff\"/>\n",
        number(width * MM),
        number(height * MM),
        number(width),
        number(height),
        escaped(&drawing.title),
        number(width),
        number(height),
    );

    for item in &drawing.items {
        match item {
            Item::Path(path) => {
                open_path(&mut out, path);
                out.push_str("/>\n");
            }
            Item::Moving(moving) => moving_element(&mut out, moving),
            Item::Text(text) => text_element(&mut out, text),
        }
    }

    out.push_str("</svg>\n");
    out
}

/// Writes the steps of a line.
fn steps(out: &mut String, line: &[PaperPoint], closed: bool) {
    for (i, point) in line.iter().enumerate() {
        let step = if i == 0 { "M" } else { "L" };
        let _ = write!(out, "{step}{} {}", number(point[0]), number(point[1]));
    }
    if closed {
        out.push('Z');
    }
}

/// Path with the animation of its points and of its colour, by SMIL.
fn moving_element(out: &mut String, moving: &Moving) {
    let Moving { path, shares, each, colours, duration } = moving;
    open_path(out, path);
    let timing = format!("dur=\"{duration}s\" repeatCount=\"indefinite\"");
    let times = |of: &mut dyn Iterator<Item = f64>| of.map(|share| format!("{share:.5}")).collect::<Vec<_>>().join(";");
    let _ = write!(
        out,
        "><animate attributeName=\"d\" {timing} keyTimes=\"{}\" values=\"",
        times(&mut shares.iter().copied())
    );
    for (k, line) in each.iter().enumerate() {
        if k > 0 {
            out.push(';');
        }
        steps(out, line, path.closed);
    }
    out.push_str("\"/>");
    if colours.len() > 1 {
        let values: Vec<String> = colours.iter().map(|(_, colour)| hex(*colour)).collect();
        let _ = write!(
            out,
            "<animate attributeName=\"stroke\" calcMode=\"discrete\" {timing} keyTimes=\"{}\" values=\"{}\"/>",
            times(&mut colours.iter().map(|(share, _)| *share)),
            values.join(";")
        );
    }
    out.push_str("</path>\n");
}

/// Path without the end of its element.
fn open_path(out: &mut String, path: &DrawnPath) {
    out.push_str("<path d=\"");
    for line in &path.lines {
        steps(out, line, path.closed);
    }
    let _ = write!(out, "\" fill=\"{}\"", path.fill.map_or_else(|| "none".to_owned(), hex));
    if let Some(stroke) = &path.stroke {
        let _ = write!(out, " stroke=\"{}\" stroke-width=\"{}\"", hex(stroke.colour), number(stroke.width));
        if !stroke.dashes.is_empty() {
            let dashes: Vec<String> = stroke.dashes.iter().map(|length| number(*length)).collect();
            let _ = write!(out, " stroke-dasharray=\"{}\"", dashes.join(" "));
        }
    }
}

fn text_element(out: &mut String, text: &Text) {
    let (x, y) = (number(text.at[0]), number(text.at[1]));
    let _ = write!(out, "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\" fill=\"{}\"", number(text.size), hex(text.colour));
    if text.angle != 0.0 {
        let _ = write!(out, " transform=\"rotate({} {x} {y})\"", number(-text.angle));
    }
    out.push('>');

    let mut was_raised = false;

    for (run, raised) in &text.label.0 {
        if *raised || was_raised {
            let (size, down) = match (was_raised, *raised) {
                (false, true) => (RAISED.0, -RAISED.1),
                (true, true) => (RAISED.0, 0.0),
                (_, false) => (1.0, RAISED.1),
            };
            let (size, down) = (number(size * text.size), number(down * text.size));
            let _ = write!(out, "<tspan dy=\"{down}\" font-size=\"{size}\">{}</tspan>", escaped(run));
            was_raised = *raised;
        } else {
            out.push_str(&escaped(run));
        }
    }

    out.push_str("</text>\n");
}

/// Number with two decimals, a hundredth of a point, without zeros at the end.
fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn hex([r, g, b]: Colour) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Text of an element. Control characters, which XML cannot hold, are left out.
fn escaped(text: &str) -> String {
    let mut out = String::new();
    for letter in text.chars() {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            letter if letter.is_control() => {}
            letter => out.push(letter),
        }
    }
    out
}
