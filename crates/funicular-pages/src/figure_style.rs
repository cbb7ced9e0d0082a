//! Widths, sizes of texts, colours and ticks of figures, for pages, for figures of papers and for front ends.

use funicular::modes::Kind;

/// Widths of columns by journal [mm]: one column and two columns, as in the instructions for authors.
pub const WIDTHS: [(&str, f64); 6] = [
    ("ieee-single", 88.9),
    ("ieee-double", 181.0),
    ("elsevier-single", 90.0),
    ("elsevier-double", 190.0),
    ("springer-single", 84.0),
    ("springer-double", 174.0),
];

/// Width of a figure if none is given [mm]: one column of IEEE.
pub const DEFAULT_WIDTH_MM: f64 = 88.9;

/// Limits of the width [mm]: a figure in the margin, and the width of a poster.
pub const WIDTH_LIMITS_MM: (f64, f64) = (40.0, 1000.0);

/// Size of the texts if none is given [pt].
pub const DEFAULT_FONT_SIZE_PT: f64 = 8.0;

/// Limits of the size of the texts [pt].
pub const FONT_SIZE_LIMITS_PT: (f64, f64) = (4.0, 40.0);

/// Colours of Okabe and Ito, which people with any colour vision can distinguish, as `#rrggbb`.
pub mod colour {
    /// Black.
    pub(crate) const BLACK: &str = "#000000";
    /// Orange.
    pub(crate) const ORANGE: &str = "#e69f00";
    /// Sky blue.
    pub(crate) const SKY: &str = "#56b4e9";
    /// Bluish green.
    pub(crate) const GREEN: &str = "#009e73";
    /// Blue.
    pub(crate) const BLUE: &str = "#0072b2";
    /// Vermilion.
    pub(crate) const VERMILION: &str = "#d55e00";
    /// Reddish purple.
    pub(crate) const PURPLE: &str = "#cc79a7";
    /// Grey, for marks that are not data.
    pub(crate) const GREY: &str = "#8a8a8a";
}

/// Red, green and blue of a colour `#rrggbb` with small letters.
pub const fn rgb(hex: &str) -> [u8; 3] {
    const fn digit(letter: u8) -> u8 {
        match letter {
            b'0'..=b'9' => letter - b'0',
            b'a'..=b'f' => letter - b'a' + 10,
            _ => panic!("a digit of a colour is 0 to 9 or a to f"),
        }
    }

    let hex = hex.as_bytes();
    assert!(hex.len() == 7 && hex[0] == b'#', "a colour is #rrggbb");
    [16 * digit(hex[1]) + digit(hex[2]), 16 * digit(hex[3]) + digit(hex[4]), 16 * digit(hex[5]) + digit(hex[6])]
}

/// Colour of a kind of mode on a page, whose marks are lines and symbols on white.
pub(crate) const fn kind_colour(kind: Kind) -> &'static str {
    match kind {
        Kind::Platform => colour::VERMILION,
        Kind::Mixed => colour::PURPLE,
        Kind::Cable => colour::SKY,
        Kind::Drive => colour::ORANGE,
    }
}

/// Tick of a natural frequency below a response, in a figure for a paper.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ModeTick {
    /// Kind of the mode.
    pub kind: Kind,
    /// Colour `#rrggbb`.
    pub colour: &'static str,
    /// Width of the line [pt].
    pub width_pt: f64,
    /// Height as a fraction of the height of its panel.
    pub height: f64,
}

/// Ticks by kind of mode. They differ in width and height, so that they differ in a print in grey, too.
pub(crate) const MODE_TICKS: [ModeTick; 4] = [
    ModeTick { kind: Kind::Cable, colour: colour::GREY, width_pt: 0.5, height: 0.45 },
    ModeTick { kind: Kind::Drive, colour: colour::BLUE, width_pt: 0.65, height: 0.6 },
    ModeTick { kind: Kind::Mixed, colour: colour::GREEN, width_pt: 0.8, height: 0.75 },
    ModeTick { kind: Kind::Platform, colour: colour::VERMILION, width_pt: 1.1, height: 1.0 },
];
