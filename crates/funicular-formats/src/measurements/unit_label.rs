//! Labels of units in files of measurements, as `g's`, `µm` or `(m/s^2)/N`: their dimension and their size in SI units.
//!
//! A label is a product of words with exponents. Case is kept where it tells units apart (`mN`, `MN`), and ignored for
//! labels that only then are units (`MM/S^2`). A label that can be read in two ways is no label that is known.

use std::f64::consts::{PI, TAU};

/// Exponents of metre, kilogram and second. Angles have no dimension.
pub(super) type Dimension = [i32; 3];

pub(super) const NO_DIMENSION: Dimension = [0, 0, 0];
pub(super) const LENGTH: Dimension = [1, 0, 0];
pub(super) const FORCE: Dimension = [1, 1, -2];
pub(super) const MOMENT: Dimension = [2, 1, -2];
const TIME: Dimension = [0, 0, 1];
const PER_TIME: Dimension = [0, 0, -1];
const ACCELERATION: Dimension = [1, 0, -2];

/// Standard acceleration of free fall [m/s²].
const GRAVITY: f64 = 9.806_65;
const INCH: f64 = 0.0254;
const POUND_FORCE: f64 = 4.448_221_615_260_5;

/// Maximum length of a label [characters]; the field of a Universal File has 20.
const MAX_LENGTH: usize = 60;

/// Maximum number of combinations of readings of a label's words.
const MAX_READINGS: usize = 256;

/// Unit with its names, the letters of prefixes that it takes, its size in SI units, its dimension and its exponent of
/// the angle.
struct Known {
    names: &'static [&'static str],
    prefixes: &'static str,
    size: f64,
    dimension: Dimension,
    angle: i32,
}

const fn known(names: &'static [&'static str], prefixes: &'static str, size: f64, dimension: Dimension) -> Known {
    Known { names, prefixes, size, dimension, angle: 0 }
}

const fn turning(names: &'static [&'static str], prefixes: &'static str, size: f64, dimension: Dimension) -> Known {
    Known { names, prefixes, size, dimension, angle: 1 }
}

/// Units of lengths, times, masses, forces, angles and their products. A mass is not used as a force: `kg` is none.
const UNITS: &[Known] = &[
    known(&["m", "meter", "meters", "metre", "metres"], "kdcmuµμn", 1.0, LENGTH),
    known(&["in", "inch", "inches", "\""], "", INCH, LENGTH),
    known(&["ft", "foot", "feet"], "", 12.0 * INCH, LENGTH),
    known(&["yd", "yard", "yards"], "", 36.0 * INCH, LENGTH),
    known(&["mil", "mils", "thou"], "", 1e-3 * INCH, LENGTH),
    known(&["micron", "microns", "micrometer", "micrometers", "micrometre", "micrometres"], "", 1e-6, LENGTH),
    known(&["millimeter", "millimeters", "millimetre", "millimetres"], "", 1e-3, LENGTH),
    known(&["s", "sec", "secs", "second", "seconds"], "muµμn", 1.0, TIME),
    known(&["min", "minute", "minutes"], "", 60.0, TIME),
    known(&["h", "hr", "hour", "hours"], "", 3600.0, TIME),
    known(&["ips"], "", INCH, [1, 0, -1]),
    known(&["g", "gs", "g's", "gn", "g_n", "g0", "gee", "gees"], "muµμn", GRAVITY, ACCELERATION),
    known(&["Gal", "gal"], "mu", 1e-2, ACCELERATION),
    known(&["kg", "kilogram", "kilograms"], "", 1.0, [0, 1, 0]),
    known(&["N", "newton", "newtons"], "kMDdcmuµμn", 1.0, FORCE),
    known(&["kilonewton", "kilonewtons"], "", 1e3, FORCE),
    known(&["lbf", "lb", "lbs", "pound", "pounds", "lb_f"], "k", POUND_FORCE, FORCE),
    known(&["kip", "kips"], "", 1e3 * POUND_FORCE, FORCE),
    known(&["ozf", "oz"], "", POUND_FORCE / 16.0, FORCE),
    known(&["pdl", "poundal"], "", 0.138_254_954_376, FORCE),
    known(&["kgf", "kp", "kg_f", "kilopond"], "", GRAVITY, FORCE),
    known(&["gf", "p", "pond"], "", 1e-3 * GRAVITY, FORCE),
    known(&["dyn", "dyne", "dynes"], "", 1e-5, FORCE),
    known(&["Nm"], "kMm", 1.0, MOMENT),
    known(&["Nmm"], "k", 1e-3, MOMENT),
    known(&["Ncm"], "", 1e-2, MOMENT),
    turning(&["rad", "radian", "radians"], "muµμn", 1.0, NO_DIMENSION),
    turning(&["deg", "degree", "degrees", "°"], "m", PI / 180.0, NO_DIMENSION),
    turning(&["rev", "revs", "r", "cycle", "cycles"], "", TAU, NO_DIMENSION),
    turning(&["Hz", "hertz", "cps"], "kMmG", TAU, PER_TIME),
    turning(&["rpm", "cpm"], "", TAU / 60.0, PER_TIME),
];

/// Prefixes by the letters of [`Known::prefixes`].
const PREFIXES: [(char, &str, f64); 11] = [
    ('G', "G", 1e9),
    ('M', "M", 1e6),
    ('k', "k", 1e3),
    ('D', "da", 1e1),
    ('d', "d", 1e-1),
    ('c', "c", 1e-2),
    ('m', "m", 1e-3),
    ('u', "u", 1e-6),
    ('µ', "µ", 1e-6),
    ('μ', "μ", 1e-6),
    ('n', "n", 1e-9),
];

/// Words of programs for a unit that they do not know.
const UNKNOWN: [&str; 9] = ["", "none", "unknown", "undefined", "unspecified", "n/a", "na", "null", "si"];

/// True if a label says nothing; the standard's SI units then hold.
pub(super) fn is_blank(label: &str) -> bool {
    let inner = label.trim_matches(|c: char| c.is_whitespace() || "()[]{}<>-_?.".contains(c));
    UNKNOWN.contains(&inner.to_lowercase().as_str())
}

/// Size of a label's unit in SI units, if the label is a unit of this dimension.
pub(super) fn size(label: &str, dimension: Dimension) -> Option<f64> {
    only(readings(label).into_iter().filter(|unit| unit.dimension == dimension).map(|unit| unit.size))
}

/// Size of a label's unit in hertz, if the label is a unit of frequency. `1/s` is a hertz, `rad/s` is none.
pub(super) fn hertz(label: &str) -> Option<f64> {
    only(readings(label).into_iter().filter(|unit| unit.dimension == PER_TIME).filter_map(|unit| match unit.angle {
        0 => Some(unit.size),
        1 => Some(unit.size / TAU),
        _ => None,
    }))
}

/// True if the words of a label are all in another label, as those of `N` in `(m/s^2)/N`.
pub(super) fn is_part_of(label: &str, whole: &str) -> bool {
    let words_of = |label: &str| words(label).unwrap_or_default();
    let whole = words_of(whole);
    words_of(label).iter().all(|word| !matches!(word, Token::Word(_)) || whole.contains(word))
}

/// The number that all of these are, if they agree.
fn only(sizes: impl Iterator<Item = f64>) -> Option<f64> {
    let mut sizes = sizes;
    let first = sizes.next()?;
    // Equal sizes differ by rounding, as of thousandths of an inch.
    sizes.all(|size| (size / first - 1.0).abs() < 1e-9).then_some(first)
}

/// Reading of a label.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Unit {
    size: f64,
    dimension: Dimension,
    angle: i32,
}

impl Unit {
    const ONE: Self = Self { size: 1.0, dimension: NO_DIMENSION, angle: 0 };

    fn times(self, other: Self) -> Self {
        let [a, b] = [self.dimension, other.dimension];
        Self {
            size: self.size * other.size,
            dimension: [a[0] + b[0], a[1] + b[1], a[2] + b[2]],
            angle: self.angle + other.angle,
        }
    }

    fn to_power(self, exponent: i32) -> Self {
        Self {
            size: self.size.powi(exponent),
            dimension: self.dimension.map(|of_base| of_base * exponent),
            angle: self.angle * exponent,
        }
    }
}

/// All readings of a label: a blank binds as `*` does, or more tightly than `/`, and a word may be several units.
fn readings(label: &str) -> Vec<Unit> {
    let mut all = Vec::new();
    let Some(tokens) = words(label) else { return all };
    for is_tight in [false, true] {
        let mut parser = Parser { tokens: &tokens, at: 0, is_tight };
        let Some(factors) = parser.product(0).filter(|_| parser.at == tokens.len()) else { continue };
        let mut found = vec![Unit::ONE];
        for (factor, exponent) in &factors {
            let of_factor = match factor {
                Token::Number(number) => vec![Unit { size: *number, ..Unit::ONE }.to_power(*exponent)],
                Token::Word(word) => units_of(word, *exponent),
                Token::Sign(_) => Vec::new(),
            };
            found = found.iter().flat_map(|unit| of_factor.iter().map(|factor| unit.times(*factor))).collect();
            if found.len() > MAX_READINGS {
                return Vec::new();
            }
        }
        all.extend(found.into_iter().filter(|unit| unit.size.is_finite() && unit.size > 0.0));
    }
    all
}

/// Units that a word with an exponent may be: those with these letters, or else those with them in another case.
fn units_of(word: &str, exponent: i32) -> Vec<Unit> {
    let matching = |is_name: &dyn Fn(&str, &str) -> bool| -> Vec<Unit> {
        let mut found = Vec::new();
        for unit in UNITS {
            let of = |size| Unit { size, dimension: unit.dimension, angle: unit.angle }.to_power(exponent);
            for name in unit.names {
                if is_name("", name) {
                    found.push(of(unit.size));
                }
                let prefixes = PREFIXES.iter().filter(|(letter, ..)| unit.prefixes.contains(*letter));
                let fitting = prefixes.filter(|(_, prefix, _)| is_name(prefix, name));
                found.extend(fitting.map(|(.., factor)| of(factor * unit.size)));
            }
        }
        found
    };

    let mut found = matching(&|prefix, name| word.strip_prefix(prefix) == Some(name));
    if found.is_empty() {
        let small = word.to_lowercase();
        found = matching(&|prefix, name| {
            small.strip_prefix(&prefix.to_lowercase()).is_some_and(|rest| rest == name.to_lowercase())
        });
    }
    // `ms-2` is m s⁻², too.
    if word == "ms" && exponent < 0 {
        found.push(Unit { size: 1.0, dimension: [1, 0, exponent], angle: 0 });
    }
    found
}

/// Part of a label.
#[derive(Debug, Clone, PartialEq)]
enum Token {
    Word(String),
    Number(f64),
    /// `*`, `/`, `^`, ` ` (nothing between two words), an opening `(` or a closing `)`.
    Sign(char),
}

/// Tokens of a label; `None` if it is too long or has other signs.
fn words(label: &str) -> Option<Vec<Token>> {
    let letters: Vec<char> = superscripts_as_powers(label.trim()).replace("**", "^").chars().collect();
    if letters.len() > MAX_LENGTH {
        return None;
    }
    let is_letter = |c: char| c.is_alphabetic() || matches!(c, '\'' | '’' | '"' | '°' | '_');
    let mut tokens: Vec<Token> = Vec::new();
    let mut at = 0;

    while at < letters.len() {
        let (c, from) = (letters[at], at);
        let after_word = at > 0 && is_letter(letters[at - 1]);
        at += 1;
        let token = match c {
            c if is_letter(c) => {
                // Digits belong to few words: `g0`.
                while letters.get(at).is_some_and(|c| is_letter(*c)) {
                    at += 1;
                }
                if letters[from..at] == ['g'] && letters.get(at) == Some(&'0') {
                    at += 1;
                }
                let word: String = letters[from..at].iter().map(|c| if *c == '’' { '\'' } else { *c }).collect();
                if word.eq_ignore_ascii_case("per") { Token::Sign('/') } else { Token::Word(word) }
            }
            c if c.is_ascii_digit() => {
                while letters.get(at).is_some_and(|c| c.is_ascii_digit() || *c == '.') {
                    at += 1;
                }
                if after_word {
                    tokens.push(Token::Sign('^'));
                }
                Token::Number(letters[from..at].iter().collect::<String>().parse().ok()?)
            }
            '-' | '−' | '+' if letters.get(at).is_some_and(char::is_ascii_digit) => {
                if after_word {
                    tokens.push(Token::Sign('^'));
                } else if !matches!(tokens[..], [.., Token::Sign('^')] | [.., Token::Sign('^'), Token::Sign('(')]) {
                    return None;
                }
                let digits = at;
                while letters.get(at).is_some_and(char::is_ascii_digit) {
                    at += 1;
                }
                let number: f64 = letters[digits..at].iter().collect::<String>().parse().ok()?;
                Token::Number(if c == '+' { number } else { -number })
            }
            '*' | '·' | '⋅' | '×' | '•' | '.' | '-' => Token::Sign('*'),
            '/' | '^' => Token::Sign(c),
            '(' | '[' | '{' => Token::Sign('('),
            ')' | ']' | '}' => Token::Sign(')'),
            c if c.is_whitespace() => Token::Sign(' '),
            _ => return None,
        };
        tokens.push(token);
    }
    Some(without_idle_blanks(&tokens))
}

/// Tokens without the blanks that do not stand between two factors.
fn without_idle_blanks(tokens: &[Token]) -> Vec<Token> {
    let is_factor_end = |token: Option<&Token>| !matches!(token, None | Some(Token::Sign('*' | '/' | '^' | '(' | ' ')));
    let begins_factor = |token: Option<&Token>| matches!(token, Some(Token::Word(_) | Token::Sign('(')));
    let mut spaced: Vec<Token> = Vec::with_capacity(tokens.len());
    for (i, token) in tokens.iter().enumerate() {
        let is_between = || is_factor_end(spaced.last()) && begins_factor(tokens.get(i + 1));
        if *token != Token::Sign(' ') || is_between() {
            spaced.push(token.clone());
        }
    }
    spaced
}

/// Label with `^-2` in place of `⁻²`.
fn superscripts_as_powers(label: &str) -> String {
    const SUPERSCRIPTS: [char; 11] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹', '⁻'];
    let mut out = String::with_capacity(label.len());
    let mut was_raised = false;
    for c in label.chars() {
        let place = SUPERSCRIPTS.iter().position(|raised| *raised == c);
        if place.is_some() && !was_raised {
            out.push('^');
        }
        was_raised = place.is_some();
        out.push(match place {
            Some(10) => '-',
            Some(digit) => char::from_digit(digit as u32, 10).unwrap_or(c),
            None => c,
        });
    }
    out
}

/// Parser of a label's tokens.
struct Parser<'a> {
    tokens: &'a [Token],
    at: usize,
    /// True if a blank binds more tightly than `/`.
    is_tight: bool,
}

impl Parser<'_> {
    /// Factors with their exponents, up to the end or a closing bracket.
    fn product(&mut self, depth: usize) -> Option<Vec<(Token, i32)>> {
        let mut factors = self.factor(depth)?;
        let mut sign = 1;
        while let Some(token) = self.tokens.get(self.at) {
            sign = match token {
                Token::Sign(')') => break,
                Token::Sign('/') => -1,
                Token::Sign(' ') if self.is_tight => sign,
                Token::Sign('*' | ' ') => 1,
                // A bracket may follow at once, as in `m(s)`.
                Token::Sign('(') => {
                    self.at -= 1;
                    1
                }
                _ => return None,
            };
            self.at += 1;
            factors.extend(self.factor(depth)?.into_iter().map(|(token, exponent)| (token, sign * exponent)));
        }
        Some(factors)
    }

    fn factor(&mut self, depth: usize) -> Option<Vec<(Token, i32)>> {
        let token = self.tokens.get(self.at)?.clone();
        self.at += 1;
        let factors = match token {
            Token::Sign('(') if depth < 8 => {
                let inner = self.product(depth + 1)?;
                if self.tokens.get(self.at) != Some(&Token::Sign(')')) {
                    return None;
                }
                self.at += 1;
                inner
            }
            Token::Word(_) | Token::Number(_) => vec![(token, 1)],
            Token::Sign(_) => return None,
        };
        let exponent = self.exponent()?;
        Some(factors.into_iter().map(|(token, of_token)| (token, of_token * exponent)).collect())
    }

    /// Exponent behind a factor, 1 if there is none.
    fn exponent(&mut self) -> Option<i32> {
        if self.tokens.get(self.at) != Some(&Token::Sign('^')) {
            return Some(1);
        }
        let is_bracketed = self.tokens.get(self.at + 1) == Some(&Token::Sign('('));
        let place = self.at + 1 + usize::from(is_bracketed);
        let Some(Token::Number(number)) = self.tokens.get(place) else { return None };
        self.at = place + 1;
        if is_bracketed {
            if self.tokens.get(self.at) != Some(&Token::Sign(')')) {
                return None;
            }
            self.at += 1;
        }
        (number.fract() == 0.0 && number.abs() <= 9.0).then_some(*number as i32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PER_FORCE: Dimension = [0, -1, 0];

    fn close(found: Option<f64>, expected: f64) -> bool {
        found.is_some_and(|found| (found / expected - 1.0).abs() < 1e-12)
    }

    #[test]
    fn labels_of_motions_and_loads_have_their_sizes() {
        for (label, dimension, expected) in [
            ("m/s^2", ACCELERATION, 1.0),
            ("m/s²", ACCELERATION, 1.0),
            ("m s⁻²", ACCELERATION, 1.0),
            ("ms-2", ACCELERATION, 1.0),
            ("m.s-2", ACCELERATION, 1.0),
            ("m*s^(-2)", ACCELERATION, 1.0),
            ("m/s/s", ACCELERATION, 1.0),
            ("m/sec**2", ACCELERATION, 1.0),
            ("M/S2", ACCELERATION, 1.0),
            ("[m/s^2]", ACCELERATION, 1.0),
            ("mm/s^2", ACCELERATION, 1e-3),
            ("MM/S^2", ACCELERATION, 1e-3),
            ("g's", ACCELERATION, GRAVITY),
            ("g’s", ACCELERATION, GRAVITY),
            ("[g]", ACCELERATION, GRAVITY),
            ("(g)", ACCELERATION, GRAVITY),
            ("G", ACCELERATION, GRAVITY),
            ("gn", ACCELERATION, GRAVITY),
            ("g0", ACCELERATION, GRAVITY),
            ("mg", ACCELERATION, 1e-3 * GRAVITY),
            ("µg", ACCELERATION, 1e-6 * GRAVITY),
            ("in/s^2", ACCELERATION, INCH),
            ("cm/s^2", ACCELERATION, 1e-2),
            ("ips", [1, 0, -1], INCH),
            ("um/s", [1, 0, -1], 1e-6),
            ("mm/min", [1, 0, -1], 1e-3 / 60.0),
            ("um", LENGTH, 1e-6),
            ("µm", LENGTH, 1e-6),
            ("μm", LENGTH, 1e-6),
            ("micron", LENGTH, 1e-6),
            ("mils", LENGTH, 2.54e-5),
            ("nm", LENGTH, 1e-9),
            ("NM", LENGTH, 1e-9),
            ("NM", MOMENT, 1.0),
            ("Nm", MOMENT, 1.0),
            ("N-m", MOMENT, 1.0),
            ("N m", MOMENT, 1.0),
            ("N.mm", MOMENT, 1e-3),
            ("ft-lb", MOMENT, 0.3048 * POUND_FORCE),
            ("inch", LENGTH, INCH),
            ("ft", LENGTH, 0.3048),
            ("mN", FORCE, 1e-3),
            ("MN", FORCE, 1e6),
            ("KN", FORCE, 1e3),
            ("daN", FORCE, 10.0),
            ("DAN", FORCE, 10.0),
            ("kp", FORCE, GRAVITY),
            ("kgf", FORCE, GRAVITY),
            ("LBF", FORCE, POUND_FORCE),
            ("kg*m/s^2", FORCE, 1.0),
            ("dyn", FORCE, 1e-5),
            ("(m/s^2)/N", PER_FORCE, 1.0),
            ("(1/N)*(m/s^2)", PER_FORCE, 1.0),
            ("m/s^2/kN", PER_FORCE, 1e-3),
            ("m/(N s^2)", PER_FORCE, 1.0),
            ("m/N s^2", PER_FORCE, 1.0),
            ("m/s^2 per N", PER_FORCE, 1.0),
            ("g/lbf", PER_FORCE, GRAVITY / POUND_FORCE),
            ("g/N", PER_FORCE, GRAVITY),
            ("1/kg", PER_FORCE, 1.0),
            ("mrad", NO_DIMENSION, 1e-3),
            ("deg/s^2", [0, 0, -2], PI / 180.0),
            ("°/s", PER_TIME, PI / 180.0),
        ] {
            assert!(close(size(label, dimension), expected), "{label}: {:?}", size(label, dimension));
        }
    }

    #[test]
    fn frequencies_are_hertz_or_radians_per_second() {
        for (label, expected) in [
            ("Hz", 1.0),
            ("HZ", 1.0),
            ("kHz", 1e3),
            ("mHz", 1e-3),
            ("1/s", 1.0),
            ("s^-1", 1.0),
            ("c/min", f64::NAN),
            ("rad/s", 1.0 / TAU),
            ("RAD/SEC", 1.0 / TAU),
            ("krad/s", f64::NAN),
            ("rpm", 1.0 / 60.0),
            ("cycles/s", 1.0),
            ("1/min", 1.0 / 60.0),
            ("deg/s", 1.0 / 360.0),
            ("MHZ", f64::NAN),
            ("s", f64::NAN),
            ("orders", f64::NAN),
        ] {
            let found = hertz(label);
            assert!(if expected.is_nan() { found.is_none() } else { close(found, expected) }, "{label}: {found:?}");
        }
        assert_eq!(hertz("Hz").map(f64::to_bits), Some(1.0_f64.to_bits()));
    }

    #[test]
    fn other_labels_are_not_known() {
        for label in [
            "V",
            "mV/g",
            "Pa",
            "dB",
            "kg",
            "m/s^2 rms",
            "EU",
            "%",
            "m/s^2/",
            "(m/s^2",
            "m^^2",
            "m/s 2",
            "mn",
            "-2m",
            "*",
        ] {
            for dimension in [ACCELERATION, LENGTH, FORCE, PER_FORCE] {
                assert_eq!(size(label, dimension), None, "{label}");
            }
        }
        assert_eq!(size(&"(".repeat(59), LENGTH), None);
        assert_eq!(size(&"nm".repeat(500), LENGTH), None);
        for label in ["", " ", "NONE", "none", "(none)", "[-]", "Unknown", "-", "n/a"] {
            assert!(is_blank(label), "{label}");
        }
        assert!(!is_blank("N") && !is_blank("m") && !is_blank("V"));
        assert!(is_part_of("N", "(m/s^2)/N") && !is_part_of("kN", "(m/s^2)/N") && is_part_of("(N)", "g/N"));
    }
}
