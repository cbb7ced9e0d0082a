//! Font of the figures: widths of texts, and the glyphs that a PDF needs.

use ttf_parser::{Face, GlyphId};

/// Noto Sans, under the Apache License 2.0.
const DATA: &[u8] = ttf_noto_sans::REGULAR;

/// Font of all texts.
pub(crate) struct Font {
    face: Face<'static>,
}

impl Font {
    pub(crate) fn new() -> Self {
        Self { face: Face::parse(DATA, 0).expect("the embedded font is complete") }
    }

    /// Bytes of the font file.
    pub(crate) fn data() -> &'static [u8] {
        DATA
    }

    /// Glyph of a letter; a question mark stands for a letter that the font lacks.
    pub(crate) fn glyph(&self, letter: char) -> u16 {
        let of = |letter| self.face.glyph_index(letter).filter(|glyph| glyph.0 != 0);
        of(letter).or_else(|| of('?')).map_or(0, |glyph| glyph.0)
    }

    /// Advance of a glyph, relative to the size of the font.
    pub(crate) fn advance(&self, glyph: u16) -> f64 {
        f64::from(self.face.glyph_hor_advance(GlyphId(glyph)).unwrap_or_default()) / self.units()
    }

    /// Width of a text at size one.
    pub(crate) fn width(&self, text: &str) -> f64 {
        text.chars().map(|letter| self.advance(self.glyph(letter))).sum()
    }

    /// Height of a capital letter, relative to the size of the font.
    pub(crate) fn capital_height(&self) -> f64 {
        self.face.capital_height().map_or(0.7, |height| f64::from(height) / self.units())
    }

    /// Height above and depth below the base line, relative to the size of the font.
    pub(crate) fn ascent_and_descent(&self) -> (f64, f64) {
        (f64::from(self.face.ascender()) / self.units(), f64::from(self.face.descender()) / self.units())
    }

    /// Box around all glyphs, relative to the size of the font: left, bottom, right, top.
    pub(crate) fn bounding_box(&self) -> [f64; 4] {
        let of = self.face.global_bounding_box();
        [of.x_min, of.y_min, of.x_max, of.y_max].map(|edge| f64::from(edge) / self.units())
    }

    fn units(&self) -> f64 {
        f64::from(self.face.units_per_em())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_font_has_every_letter_that_figures_use() {
        let font = Font::new();
        let unknown = font.glyph('\u{10ffff}');
        for letter in "abcXYZ0189 .,:;()[]/%−–·×°²³≤µωσξλ".chars() {
            assert_ne!(font.glyph(letter), unknown, "{letter}");
        }
        // All digits of Noto Sans have a width of 1171 units, of which 2048 are its size.
        assert!((font.width("0123456789") - 11710.0 / 2048.0).abs() < 1e-12, "{}", font.width("0123456789"));
        assert!((font.capital_height() - 0.714).abs() < 0.01);
    }
}
