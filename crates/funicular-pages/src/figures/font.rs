//! Font of the figures: widths of texts, and the glyphs that a PDF needs.

use skrifa::instance::{LocationRef, Size};
use skrifa::metrics::Metrics;
use skrifa::{FontRef, GlyphId, MetadataProvider as _};

/// Noto Sans, under the Apache License 2.0.
const DATA: &[u8] = ttf_noto_sans::REGULAR;

/// Font of all texts.
pub(crate) struct Font {
    font: FontRef<'static>,
    metrics: Metrics,
}

impl Font {
    pub(crate) fn new() -> Self {
        let font = FontRef::new(DATA).expect("the embedded font is complete");
        let metrics = font.metrics(Size::unscaled(), LocationRef::default());
        Self { font, metrics }
    }

    /// Bytes of the font file.
    pub(crate) fn data() -> &'static [u8] {
        DATA
    }

    /// Glyph of a letter; a question mark stands for a letter that the font lacks.
    pub(crate) fn glyph(&self, letter: char) -> u16 {
        let of = |letter| self.font.charmap().map(letter).filter(|glyph| *glyph != GlyphId::NOTDEF);
        let glyph = of(letter).or_else(|| of('?')).unwrap_or_default();
        u16::try_from(glyph.to_u32()).expect("a TrueType font numbers its glyphs with 16 bits")
    }

    /// Advance of a glyph, relative to the size of the font.
    pub(crate) fn advance(&self, glyph: u16) -> f64 {
        let widths = self.font.glyph_metrics(Size::unscaled(), LocationRef::default());
        self.relative(widths.advance_width(glyph.into()).unwrap_or_default())
    }

    /// Width of a text at size one.
    pub(crate) fn width(&self, text: &str) -> f64 {
        text.chars().map(|letter| self.advance(self.glyph(letter))).sum()
    }

    /// Height of a capital letter, relative to the size of the font.
    pub(crate) fn capital_height(&self) -> f64 {
        self.relative(self.metrics.cap_height.unwrap_or(0.7 * f32::from(self.metrics.units_per_em)))
    }

    /// Height above and depth below the base line, relative to the size of the font.
    pub(crate) fn ascent_and_descent(&self) -> (f64, f64) {
        (self.relative(self.metrics.ascent), self.relative(self.metrics.descent))
    }

    /// Box around all glyphs, relative to the size of the font: left, bottom, right, top.
    pub(crate) fn bounding_box(&self) -> [f64; 4] {
        let edges = self.metrics.bounds.unwrap_or_default();
        [edges.x_min, edges.y_min, edges.x_max, edges.y_max].map(|edge| self.relative(edge))
    }

    /// Length in units of the font, relative to its size.
    fn relative(&self, units: f32) -> f64 {
        f64::from(units) / f64::from(self.metrics.units_per_em)
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
