//! Rows of a grid as a VTK image (`.vti`), for ParaView.

use crate::Rows;
use base64::engine::general_purpose::STANDARD;
use base64::write::EncoderWriter;
use funicular_study::request::Axis;
use funicular_study::sweep::AXES;
use funicular_study::table::{Column, ColumnKind, Record, Values, axes_of};
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, BytesText, Event};
use std::io::{self, Write};

/// Three axes of an image: first value, step and number of values of each.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Image {
    origin: [f64; 3],
    spacing: [f64; 3],
    counts: [usize; 3],
}

/// Checks that the rows of a record form an image; the error gives the reason if they do not.
pub(crate) fn check(record: &Record) -> Result<(), String> {
    Image::of(record).map(|_| ())
}

impl Image {
    /// Axes of the image: the positions if only positions vary, otherwise the varying axes in their order.
    fn of(record: &Record) -> Result<Self, String> {
        let no_grid = || "an image needs a grid, and the poses are a list".to_owned();
        let axes = axes_of(&record.plan).ok_or_else(no_grid)?;
        let axes: Vec<(&str, [f64; 2], usize)> = axes.iter().map(axis).collect::<Result<_, _>>()?;
        let varying: Vec<_> = axes.iter().copied().filter(|axis| axis.2 > 1).collect();
        let positions_only = varying.iter().all(|axis| AXES[..3].contains(&axis.0));
        let chosen: Vec<_> = if positions_only {
            axes.iter().copied().filter(|axis| AXES[..3].contains(&axis.0)).collect()
        } else {
            varying
        };
        if chosen.len() > 3 {
            return Err(format!("an image has three axes, and {} vary", chosen.len()));
        }
        let mut image = Self { origin: [0.0; 3], spacing: [1.0; 3], counts: [1; 3] };
        for (i, (_, [origin, spacing], count)) in chosen.into_iter().enumerate() {
            (image.origin[i], image.spacing[i], image.counts[i]) = (origin, spacing, count);
        }
        Ok(image)
    }
}

/// Name of an axis, its first value and step, and its number of values.
fn axis(axis: &Axis) -> Result<(&str, [f64; 2], usize), String> {
    match axis {
        Axis::Range { axis, from, to, count } => {
            let step = (to - from) / (count.max(&2) - 1) as f64;
            Ok((axis, [*from, step], *count))
        }
        Axis::List { axis, values } => match values[..] {
            [value] => Ok((axis, [value, 1.0], 1)),
            _ => Err(format!("an image has equal steps: give the axis {axis} as from:to:count")),
        },
    }
}

/// Writes the image. Missing numbers are NaN, because VTK has no missing values. `feasible` and `status` (position of
/// the code in [`funicular_study::sweep::CODES`]) give the reason.
pub(crate) fn write(out: impl Write, record: &Record, rows: &dyn Rows) -> io::Result<()> {
    let image = Image::of(record).map_err(io::Error::other)?;
    let [x, y, z] = image.counts.map(|count| count - 1);
    let extent = format!("0 {x} 0 {y} 0 {z}");
    let listed = |values: [f64; 3]| values.map(|value| format!("{value:e}")).join(" ");
    let (origin, spacing) = (listed(image.origin), listed(image.spacing));
    let mut out = Writer::new(out);
    out.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    let root = [("type", "ImageData"), ("version", "1.0"), ("byte_order", "LittleEndian"), ("header_type", "UInt64")];
    let whole = [("WholeExtent", extent.as_str()), ("Origin", &origin), ("Spacing", &spacing)];
    out.write_event(Event::Start(BytesStart::new("VTKFile").with_attributes(root)))?;
    out.write_event(Event::Start(BytesStart::new("ImageData").with_attributes(whole)))?;
    out.write_event(Event::Start(BytesStart::new("Piece").with_attributes([("Extent", extent.as_str())])))?;
    out.write_event(Event::Start(BytesStart::new("PointData")))?;

    for (i, column) in record.columns.iter().enumerate() {
        // Reasons are sentences with different numbers in each row: an image cannot hold them.
        if column.name != "reason" {
            array(&mut out, record, rows, i, column)?;
        }
    }

    for name in ["PointData", "Piece", "ImageData", "VTKFile"] {
        out.write_event(Event::End(BytesEnd::new(name)))?;
    }
    out.get_mut().write_all(b"\n")?;
    out.get_mut().flush()
}

/// Writes one column: its size in bytes, then its values, both in base64. Reads all rows once, so that no column is
/// held in memory.
fn array(out: &mut Writer<impl Write>, record: &Record, rows: &dyn Rows, i: usize, column: &Column) -> io::Result<()> {
    let (kind, size) = match column.kind {
        ColumnKind::Real => ("Float64", 8),
        ColumnKind::Flag | ColumnKind::Text => ("UInt8", 1),
    };
    let attributes = [("type", kind), ("Name", column.name.as_str()), ("format", "binary")];
    out.write_event(Event::Start(BytesStart::new("DataArray").with_attributes(attributes)))?;
    let mut packed = EncoderWriter::new(out.get_mut(), &STANDARD);
    packed.write_all(&(size * record.rows as u64).to_le_bytes())?;
    rows.each(&mut |chunk| match &chunk.columns[i] {
        Values::Real(values) => {
            values.iter().try_for_each(|value| packed.write_all(&value.unwrap_or(f64::NAN).to_le_bytes()))
        }
        Values::Flag(values) => values.iter().try_for_each(|value| packed.write_all(&[u8::from(*value)])),
        Values::Text(values) => values.iter().try_for_each(|value| packed.write_all(&[number(value.as_deref())])),
    })?;
    packed.finish()?;
    drop(packed);
    out.write_event(Event::End(BytesEnd::new("DataArray")))?;

    if column.name == "status" {
        let codes = funicular_study::sweep::CODES.iter().enumerate().map(|(i, (code, _))| format!("{i} {code}"));
        let comment = format!(" status: {} ", codes.collect::<Vec<_>>().join(", "));
        out.write_event(Event::Comment(BytesText::from_escaped(comment)))?;
    }
    Ok(())
}

/// Number of a word: position of a status among the codes, or of a mode's kind among the kinds; 255 for a missing
/// value.
fn number(word: Option<&str>) -> u8 {
    let codes = funicular_study::sweep::CODES.iter().map(|code| code.0);
    let kinds = ["platform", "cable", "mixed"];
    let place = word.and_then(|word| {
        codes.into_iter().position(|code| code == word).or(kinds.iter().position(|kind| *kind == word))
    });
    place.and_then(|place| u8::try_from(place).ok()).unwrap_or(u8::MAX)
}
