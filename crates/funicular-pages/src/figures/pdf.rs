//! Drawings as PDF: a page of the size of each, with the used letters of the font embedded.

use super::drawing::{Colour, Drawing, DrawnPath, Item, Moving, RAISED, Text};
use super::font::Font;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use pdf_writer::types::{CidFontType, FontFlags, LineJoinStyle, SystemInfo, UnicodeCmap};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, Str, TextStr};
use std::collections::BTreeMap;
use std::io::Write as _;
use subsetter::GlyphRemapper;

/// Name of the font among the resources of the page.
const FONT: Name = Name(b"F");
const SYSTEM: SystemInfo<'_> = SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"Identity"), supplement: 0 };

/// Bytes of the PDF file.
pub(crate) fn pdf(drawing: &Drawing) -> Vec<u8> {
    pages(std::slice::from_ref(drawing))
}

/// Bytes of a PDF file with a page for each drawing, the title of the first, and one font.
///
/// # Panics
/// Without a drawing.
pub(crate) fn pages(drawings: &[Drawing]) -> Vec<u8> {
    let [catalog, tree, info] = [1, 2, 5].map(Ref::new);
    let font = Ref::new(6);
    // The font takes five objects.
    let of_page = |k: usize| {
        let k = i32::try_from(k).expect("a document has few pages");
        let first = if k == 0 { 3 } else { 9 + 2 * k };
        [first, first + 1].map(Ref::new)
    };
    let letters = Letters::of(drawings);

    let mut pdf = Pdf::new();
    pdf.catalog(catalog).pages(tree);
    let count = i32::try_from(drawings.len()).expect("a document has few pages");
    pdf.pages(tree).kids((0..drawings.len()).map(|k| of_page(k)[0])).count(count);
    let write_page = |pdf: &mut Pdf, k: usize, drawing: &Drawing| {
        let [page, content] = of_page(k);
        let mut written = pdf.page(page);
        let sides = Rect::new(0.0, 0.0, drawing.width as f32, drawing.height as f32);
        written.parent(tree).media_box(sides).contents(content);
        written.resources().fonts().pair(FONT, font);
    };
    write_page(&mut pdf, 0, &drawings[0]);
    let creator = concat!("funicular ", env!("CARGO_PKG_VERSION"));
    pdf.document_info(info).title(TextStr(&drawings[0].title)).creator(TextStr(creator)).producer(TextStr(creator));

    let bytes = packed(&page_content(&drawings[0], &letters));
    pdf.stream(of_page(0)[1], &bytes).filter(Filter::FlateDecode);
    embed(&mut pdf, font, &drawings[0].font, &letters);
    for (k, drawing) in drawings.iter().enumerate().skip(1) {
        write_page(&mut pdf, k, drawing);
        let bytes = packed(&page_content(drawing, &letters));
        pdf.stream(of_page(k)[1], &bytes).filter(Filter::FlateDecode);
    }
    pdf.finish()
}

/// Letters of drawings with their glyphs in the embedded font.
struct Letters {
    by_letter: BTreeMap<char, u16>,
    remapper: GlyphRemapper,
}

impl Letters {
    fn of(drawings: &[Drawing]) -> Self {
        let mut by_letter = BTreeMap::new();
        for item in drawings.iter().flat_map(|drawing| &drawing.items) {
            let Item::Text(text) = item else { continue };
            by_letter.extend(text.label.0.iter().flat_map(|(run, _)| run.chars()).map(|letter| (letter, 0)));
        }
        let mut remapper = GlyphRemapper::new();
        for (letter, glyph) in &mut by_letter {
            *glyph = remapper.remap(drawings[0].font.glyph(*letter));
        }
        Self { by_letter, remapper }
    }

    /// Bytes that show a text: two for each letter.
    fn encoded(&self, text: &str) -> Vec<u8> {
        text.chars().flat_map(|letter| self.by_letter[&letter].to_be_bytes()).collect()
    }
}

/// Embeds the font with the objects that follow `font`.
fn embed(pdf: &mut Pdf, font: Ref, face: &Font, letters: &Letters) {
    let [cid, descriptor, unicode, file] = [1, 2, 3, 4].map(|k| Ref::new(font.get() + k));
    let subset = subsetter::subset(Font::data(), 0, &letters.remapper).expect("the embedded font is complete");
    let per_mille = |value: f64| (1000.0 * value) as f32;

    // Six letters mark the name of a subset; they differ between different subsets.
    let sum = letters.by_letter.keys().fold(0_u64, |sum, letter| sum.wrapping_mul(131).wrapping_add(*letter as u64));
    let tag: String = (0..6).map(|k| char::from(b'A' + (sum / 26_u64.pow(k) % 26) as u8)).collect();
    let name = format!("{tag}+NotoSans");
    let name = Name(name.as_bytes());

    pdf.type0_font(font)
        .base_font(name)
        .encoding_predefined(Name(b"Identity-H"))
        .descendant_font(cid)
        .to_unicode(unicode);
    let mut of_cid = pdf.cid_font(cid);
    of_cid.subtype(CidFontType::Type2).base_font(name).system_info(SYSTEM).font_descriptor(descriptor);
    of_cid.default_width(0.0).cid_to_gid_map_predefined(Name(b"Identity"));
    of_cid.widths().consecutive(0, letters.remapper.remapped_gids().map(|glyph| per_mille(face.advance(glyph))));
    of_cid.finish();

    let (ascent, descent) = face.ascent_and_descent();
    let [left, bottom, right, top] = face.bounding_box().map(per_mille);
    pdf.font_descriptor(descriptor)
        .name(name)
        .flags(FontFlags::NON_SYMBOLIC)
        .bbox(Rect::new(left, bottom, right, top))
        .italic_angle(0.0)
        .ascent(per_mille(ascent))
        .descent(per_mille(descent))
        .cap_height(per_mille(face.capital_height()))
        // Thickness of the upright strokes of this font.
        .stem_v(80.0)
        .font_file2(file);

    let mut map = UnicodeCmap::new(Name(b"Letters"), SYSTEM);
    // Letters that the font lacks share one glyph; its text is the first of them.
    let mut by_glyph = BTreeMap::new();
    for (letter, glyph) in &letters.by_letter {
        by_glyph.entry(*glyph).or_insert(*letter);
    }
    for (glyph, letter) in by_glyph {
        map.pair(glyph, letter);
    }
    pdf.cmap(unicode, map.finish().as_slice());

    let bytes = packed(&subset);
    pdf.stream(file, &bytes)
        .filter(Filter::FlateDecode)
        .pair(Name(b"Length1"), i32::try_from(subset.len()).unwrap_or(i32::MAX));
}

/// Operators that draw the page.
fn page_content(drawing: &Drawing, letters: &Letters) -> Vec<u8> {
    let mut content = Content::new();
    content.set_line_join(LineJoinStyle::RoundJoin);
    for item in &drawing.items {
        match item {
            Item::Path(path) | Item::Moving(Moving { path, .. }) => draw_path(&mut content, path, drawing.height),
            Item::Text(text) => draw_text(&mut content, text, drawing, letters),
        }
    }
    content.finish().as_slice().to_vec()
}

fn draw_path(content: &mut Content, path: &DrawnPath, height: f64) {
    if let Some(fill) = path.fill {
        let [r, g, b] = parts(fill);
        content.set_fill_rgb(r, g, b);
    }

    if let Some(stroke) = &path.stroke {
        let [r, g, b] = parts(stroke.colour);
        content.set_stroke_rgb(r, g, b).set_line_width(stroke.width as f32);
        content.set_dash_pattern(stroke.dashes.iter().map(|length| *length as f32), 0.0);
    }

    for line in &path.lines {
        for (i, point) in line.iter().enumerate() {
            let (x, y) = (rounded(point[0]), rounded(height - point[1]));
            if i == 0 {
                content.move_to(x, y);
            } else {
                content.line_to(x, y);
            }
        }
        if path.closed {
            content.close_path();
        }
    }

    match (path.fill.is_some(), path.stroke.is_some()) {
        (true, true) => content.fill_nonzero_and_stroke(),
        (true, false) => content.fill_nonzero(),
        (false, true) => content.stroke(),
        (false, false) => content.end_path(),
    };
}

fn draw_text(content: &mut Content, text: &Text, drawing: &Drawing, letters: &Letters) {
    let (sin, cos) = text.angle.to_radians().sin_cos();
    let [r, g, b] = parts(text.colour);
    let (x, y) = (rounded(text.at[0]), rounded(drawing.height - text.at[1]));
    content.begin_text().set_fill_rgb(r, g, b);
    content.set_text_matrix([cos as f32, sin as f32, -sin as f32, cos as f32, x, y]);
    for (run, raised) in &text.label.0 {
        let (size, rise) = if *raised { (RAISED.0 * text.size, RAISED.1 * text.size) } else { (text.size, 0.0) };
        content.set_font(FONT, size as f32).set_rise(rise as f32).show(Str(&letters.encoded(run)));
    }
    // The rise outlives the text.
    content.set_rise(0.0).end_text();
}

/// Coordinate rounded to a hundredth of a point.
fn rounded(value: f64) -> f32 {
    ((100.0 * value).round() / 100.0) as f32
}

fn parts(colour: Colour) -> [f32; 3] {
    colour.map(|part| f32::from(part) / 255.0)
}

/// Bytes packed for a stream.
fn packed(bytes: &[u8]) -> Vec<u8> {
    const INTO_MEMORY: &str = "writing to memory cannot fail";
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).expect(INTO_MEMORY);
    encoder.finish().expect(INTO_MEMORY)
}
