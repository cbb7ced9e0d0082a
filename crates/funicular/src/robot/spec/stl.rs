//! STL files, binary and text, with the line of what is wrong. A text may have several solids: their triangles together
//! are the mesh.

use super::read::shortened;
use thiserror::Error;

/// Triangle by its corners.
pub(super) type Corners = [[f32; 3]; 3];

/// Bytes of a binary file before its triangles: a title, and the number of triangles.
const HEAD: usize = 84;

/// Bytes of the title.
const TITLE: usize = 80;

/// Bytes of a triangle: normal, three corners, and two without meaning.
const TRIANGLE: usize = 50;

/// Marks at the beginning of text in UTF-8.
const BYTE_ORDER_MARK: &[u8] = &[0xef, 0xbb, 0xbf];

/// Reason for which bytes are no STL file.
#[derive(Debug, Clone, PartialEq, Error)]
pub(super) enum StlError {
    /// Neither a text nor long enough to be binary.
    #[error("a text begins with `solid`, and a binary file has at least 84 bytes, not {bytes}")]
    Neither { bytes: usize },
    /// A binary file with fewer triangles than it says.
    #[error(
        "a text begins with `solid`, and a binary file of {triangles} triangles has at least {needed} bytes, not \
         {bytes}"
    )]
    Short { triangles: usize, needed: usize, bytes: usize },
    /// A corner of a binary file that is no number.
    #[error("triangle {triangle} has a corner that is no finite number")]
    NoNumber { triangle: usize },
    /// A text with another word than the format has there.
    #[error("line {line}: `{found}` stands where `{expected}` belongs")]
    Word { line: usize, found: String, expected: &'static str },
    /// A text with a coordinate that is no number.
    #[error("line {line}: the coordinate `{found}` is no finite number")]
    Coordinate { line: usize, found: String },
    /// A text that ends within a solid.
    #[error("line {line}: the text ends where `{expected}` belongs, in the solid that begins at line {begins}")]
    CutOff { line: usize, expected: &'static str, begins: usize },
}

/// Triangles of a file.
///
/// # Errors
/// [`StlError`].
pub(super) fn read(bytes: &[u8]) -> Result<Vec<Corners>, StlError> {
    let text = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes).trim_ascii_start();
    let begins_as_text = text.get(..SOLID.len()).is_some_and(|word| word.eq_ignore_ascii_case(SOLID.as_bytes()));
    // Titles of binary files begin with the same word, but their numbers have zeros, and a text has none.
    if begins_as_text && !text.contains(&0) { read_text(bytes) } else { read_binary(bytes) }
}

fn read_binary(bytes: &[u8]) -> Result<Vec<Corners>, StlError> {
    let Some((head, rest)) = bytes.split_at_checked(HEAD) else {
        return Err(StlError::Neither { bytes: bytes.len() });
    };
    let triangles = head[TITLE..].iter().rev().fold(0, |number, byte| number << 8 | usize::from(*byte));
    if rest.len() / TRIANGLE < triangles {
        return Err(StlError::Short { triangles, needed: HEAD + TRIANGLE * triangles, bytes: bytes.len() });
    }

    let corners = rest.chunks_exact(TRIANGLE).take(triangles).enumerate().map(|(k, triangle)| {
        let number = |at: usize| {
            let at = 4 * at;
            f32::from_le_bytes([triangle[at], triangle[at + 1], triangle[at + 2], triangle[at + 3]])
        };
        // The normal comes first.
        let corners = [3, 6, 9].map(|first| [0, 1, 2].map(|axis| number(first + axis)));
        let is_finite = corners.iter().flatten().all(|number| number.is_finite());
        if is_finite { Ok(corners) } else { Err(StlError::NoNumber { triangle: k + 1 }) }
    });
    corners.collect()
}

/// Words of a text.
const SOLID: &str = "solid";
const END_OF_SOLID: &str = "endsolid";
const FACET: &str = "facet";

/// Word of a text and the line in which it stands.
#[derive(Clone, Copy)]
struct Word<'a> {
    text: &'a str,
    line: usize,
}

impl Word<'_> {
    fn is(&self, other: &str) -> bool {
        self.text.eq_ignore_ascii_case(other)
    }
}

/// Words of a text in their order.
struct Words<'a> {
    ahead: std::iter::Peekable<std::vec::IntoIter<Word<'a>>>,
    /// Line of the word that was read last.
    line: usize,
    /// Line at which the solid begins.
    begins: usize,
}

fn read_text(bytes: &[u8]) -> Result<Vec<Corners>, StlError> {
    // Names may be in any encoding, and the byte-order mark is one of white space then.
    let text = String::from_utf8_lossy(bytes).replace("\r\n", "\n");
    let lines = text.trim_start_matches('\u{feff}').split(['\n', '\r']).enumerate();
    let words: Vec<Word> = lines
        .flat_map(|(k, line)| {
            let words = line.split_whitespace().map(move |text| Word { text, line: k + 1 });
            // Behind these words stands a name.
            let named = [SOLID, END_OF_SOLID];
            let is_named = words.clone().next().is_some_and(|first| named.iter().any(|word| first.is(word)));
            words.take(if is_named { 1 } else { usize::MAX })
        })
        .collect();
    let mut words = Words { ahead: words.into_iter().peekable(), line: 1, begins: 1 };

    let mut corners = Vec::new();
    while words.ahead.peek().is_some() {
        words.expect(SOLID)?;
        words.begins = words.line;
        while words.ahead.peek().is_some_and(|word| word.is(FACET)) {
            corners.push(words.facet()?);
        }
        words.expect(END_OF_SOLID)?;
    }
    Ok(corners)
}

impl<'a> Words<'a> {
    fn next(&mut self, expected: &'static str) -> Result<Word<'a>, StlError> {
        let Self { ahead: words, line, begins } = self;
        let word = words.next().ok_or(StlError::CutOff { line: *line, expected, begins: *begins })?;
        *line = word.line;
        Ok(word)
    }

    fn expect(&mut self, expected: &'static str) -> Result<(), StlError> {
        let word = self.next(expected)?;
        if word.is(expected) {
            return Ok(());
        }
        Err(StlError::Word { line: word.line, found: shortened(word.text), expected })
    }

    /// Reads a triangle. Its normal is not used: many programs write zeros or `nan`.
    fn facet(&mut self) -> Result<Corners, StlError> {
        self.expect(FACET)?;
        self.expect("normal")?;
        for _ in 0..3 {
            self.next("a component of the normal")?;
        }
        self.expect("outer")?;
        self.expect("loop")?;
        let corners = [self.corner()?, self.corner()?, self.corner()?];
        self.expect("endloop")?;
        self.expect("endfacet")?;
        Ok(corners)
    }

    fn corner(&mut self) -> Result<[f32; 3], StlError> {
        self.expect("vertex")?;
        Ok([self.coordinate()?, self.coordinate()?, self.coordinate()?])
    }

    fn coordinate(&mut self) -> Result<f32, StlError> {
        let word = self.next("a coordinate")?;
        let number = word.text.parse().ok().filter(|number: &f32| number.is_finite());
        number.ok_or_else(|| StlError::Coordinate { line: word.line, found: shortened(word.text) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FACETS: [&str; 2] = [
        "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 1.5e0 0\n endloop\nendfacet\n",
        "facet normal nan nan nan\nouter loop\nvertex 1 0 0\nvertex 1 1 -2\nvertex 0 1 0\nendloop\nendfacet\n",
    ];

    fn two_solids() -> String {
        format!("solid the first part\n{}endsolid the first part\n\nsolid\n{}endsolid\n", FACETS[0], FACETS[1])
    }

    const EXPECTED: [Corners; 2] =
        [[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.5, 0.0]], [[1.0, 0.0, 0.0], [1.0, 1.0, -2.0], [0.0, 1.0, 0.0]]];

    #[test]
    fn all_solids_of_a_text_are_read_in_every_spelling() {
        let plain = two_solids();
        let texts = [
            plain.clone(),
            plain.to_uppercase(),
            format!("\u{feff}{plain}"),
            plain.replace('\n', "\r"),
            plain.replace('\n', "\r\n"),
            plain.replace("outer loop\n", "outer loop "),
            format!("\n\t {plain}  \n"),
        ];
        for text in texts {
            assert_eq!(read(text.as_bytes()).as_deref(), Ok(&EXPECTED[..]), "{text}");
        }
        let latin = plain.replace("first", "fir\u{e9}st").chars().map(|c| c as u8).collect::<Vec<u8>>();
        assert_eq!(read(&latin).as_deref(), Ok(&EXPECTED[..]));
        assert_eq!(read(b"solid empty\nendsolid empty\n").as_deref(), Ok(&[][..]));
    }

    #[test]
    fn a_text_that_breaks_off_or_goes_wrong_is_refused_with_its_line() {
        let plain = two_solids();
        let cut = |at: &str| plain[..plain.rfind(at).unwrap()].to_owned();
        let cases = [
            (cut("endsolid"), "line 18: the text ends where `endsolid` belongs, in the solid that begins at line 11"),
            (cut("endfacet"), "line 17: the text ends where `endfacet` belongs"),
            (cut(" 1 0\nendloop"), "line 16: the text ends where `a coordinate` belongs"),
            (cut("solid\nfacet") + "soli", "line 11: `soli` stands where `solid` belongs"),
            (plain.replace("1.5e0", "nan"), "line 6: the coordinate `nan` is no finite number"),
            (plain.replace("1.5e0", "1e99"), "line 6: the coordinate `1e99`"),
            (plain.replace("1.5e0", "1,5"), "line 6: the coordinate `1,5`"),
            (
                plain.replacen(" endloop", " vertex 1 1 1\n endloop", 1),
                "line 7: `vertex` stands where `endloop` belongs",
            ),
            (plain.replacen(" outer loop\n", "", 1), "line 3: `vertex` stands where `outer` belongs"),
        ];
        for (text, words) in cases {
            let found = read(text.as_bytes()).unwrap_err().to_string();
            assert!(found.contains(words), "{found}");
        }
    }

    #[test]
    fn binary_files_are_read_with_any_title_and_short_ones_are_refused() {
        let mut bytes = b"solid by a program".to_vec();
        bytes.resize(TITLE, b' ');
        bytes.extend(2_u32.to_le_bytes());
        for triangle in EXPECTED {
            bytes.extend([0; 12]);
            bytes.extend(triangle.iter().flatten().flat_map(|number| number.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        assert_eq!(read(&bytes).as_deref(), Ok(&EXPECTED[..]));
        assert_eq!(read(&[&bytes[..], &[1, 2, 3]].concat()).as_deref(), Ok(&EXPECTED[..]));

        assert_eq!(read(&bytes[..170]), Err(StlError::Short { triangles: 2, needed: 184, bytes: 170 }));
        assert_eq!(read(&bytes[18..60]), Err(StlError::Neither { bytes: 42 }));
        assert_eq!(read(b""), Err(StlError::Neither { bytes: 0 }));
        let mut infinite = bytes.clone();
        infinite[HEAD + TRIANGLE + 12..HEAD + TRIANGLE + 16].copy_from_slice(&f32::INFINITY.to_le_bytes());
        assert_eq!(read(&infinite), Err(StlError::NoNumber { triangle: 2 }));
    }
}
