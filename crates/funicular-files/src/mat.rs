//! Files of MATLAB, level 5 (`.mat`), which `load` of MATLAB, Octave and `scipy.io.loadmat` read.
//!
//! Written here, because the libraries for this format need a C library or are not maintained, and a file of full real
//! matrices and texts takes few lines. Equal variables give equal files: there is no time in the header.

/// Variable of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable<'a> {
    /// Name: a letter, then letters, digits and underscores, at most 63 in all.
    pub name: &'a str,
    /// Value.
    pub value: Value<'a>,
}

/// Value of a variable.
#[derive(Debug, Clone, PartialEq)]
pub enum Value<'a> {
    /// Real matrix: number of rows, and the entries by columns.
    Matrix(usize, &'a [f64]),
    /// Column of texts (a cell array in MATLAB).
    Texts(Vec<&'a str>),
}

/// Bytes of the descriptive text at the beginning of a file.
const TEXT: usize = 116;
/// Bytes to whose multiples every element is filled up.
const ALIGNMENT: usize = 8;

// Types of data elements and classes of arrays, from the format's tables 1-1 and 1-3.
const INT8: u32 = 1;
const UINT16: u32 = 4;
const INT32: u32 = 5;
const UINT32: u32 = 6;
const DOUBLE: u32 = 9;
const MATRIX: u32 = 14;
const CELL_CLASS: u32 = 1;
const CHAR_CLASS: u32 = 4;
const DOUBLE_CLASS: u32 = 6;

/// Bytes of a file with these variables. A matrix whose entries do not fill its rows is refused by `None`, and so is a
/// variable of 4 GiB and more, or a name that MATLAB cannot read.
///
/// # References
/// MathWorks, MAT-File Format, version 5, 2019.
pub fn bytes(variables: &[Variable]) -> Option<Vec<u8>> {
    let mut file = format!("{:TEXT$}", "MATLAB 5.0 MAT-file, written by funicular").into_bytes();
    // No data of subsystems; version 1; "MI" of a file with the least significant byte first.
    file.extend([0; 8]);
    file.extend([0x00, 0x01, b'I', b'M']);
    for variable in variables {
        file.extend(array(variable.name, &variable.value)?);
    }
    Some(file)
}

/// Data element of an array with a name; elements of cells have an empty name.
fn array(name: &str, value: &Value) -> Option<Vec<u8>> {
    match value {
        Value::Matrix(rows, entries) => {
            let columns = if *rows == 0 { 0 } else { entries.len() / rows };
            if rows * columns != entries.len() {
                return None;
            }
            let data: Vec<u8> = entries.iter().flat_map(|entry| entry.to_le_bytes()).collect();
            filled(DOUBLE_CLASS, [*rows, columns], name, &element(DOUBLE, &data)?)
        }
        Value::Texts(texts) => {
            let cells: Option<Vec<Vec<u8>>> = texts.iter().map(|text| characters(text)).collect();
            filled(CELL_CLASS, [texts.len(), 1], name, &cells?.concat())
        }
    }
}

/// Data element of a text.
fn characters(text: &str) -> Option<Vec<u8>> {
    let units: Vec<u16> = text.encode_utf16().collect();
    let data: Vec<u8> = units.iter().flat_map(|unit| unit.to_le_bytes()).collect();
    filled(CHAR_CLASS, [usize::from(!units.is_empty()), units.len()], "", &element(UINT16, &data)?)
}

/// Data element of an array from its class, its numbers of rows and columns, its name and its data.
fn filled(class: u32, shape: [usize; 2], name: &str, data: &[u8]) -> Option<Vec<u8>> {
    const MAX_NAME: usize = 63;
    let is_word = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    if !is_word || name.starts_with(|c: char| !c.is_ascii_alphabetic()) || name.len() > MAX_NAME {
        return None;
    }
    let flags = [class.to_le_bytes(), [0; 4]].concat();
    let sizes: Option<Vec<[u8; 4]>> = shape.iter().map(|n| Some(i32::try_from(*n).ok()?.to_le_bytes())).collect();
    let parts = [element(UINT32, &flags)?, element(INT32, &sizes?.concat())?, element(INT8, name.as_bytes())?];
    element(MATRIX, &[&parts.concat(), data].concat())
}

/// Data element: type, number of bytes, and the bytes, filled up with zeros.
fn element(kind: u32, data: &[u8]) -> Option<Vec<u8>> {
    let length = u32::try_from(data.len()).ok()?;
    let mut bytes = [&kind.to_le_bytes()[..], &length.to_le_bytes(), data].concat();
    bytes.resize(bytes.len().next_multiple_of(ALIGNMENT), 0);
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_stands_in_a_file_as_the_format_prescribes() {
        let entries = [1.0, -2.5, 3.0, 4.0, 5.0, 6.0];
        let file = bytes(&[Variable { name: "ss_A", value: Value::Matrix(3, &entries) }]).unwrap();
        assert!(file.starts_with(b"MATLAB 5.0 MAT-file"));
        assert_eq!(&file[124..128], [0, 1, b'I', b'M']);
        let number = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap());
        // One array, to the end of the file.
        assert_eq!((number(128), number(132) as usize), (14, file.len() - 136));
        // Flags, two dimensions, the name with its filling, and the entries by columns.
        assert_eq!([136, 140, 144].map(number), [6, 8, 6]);
        assert_eq!([152, 156, 160, 164].map(number), [5, 8, 3, 2]);
        assert_eq!((number(168), number(172), &file[176..184]), (1, 4, &b"ss_A\0\0\0\0"[..]));
        assert_eq!((number(184), number(188)), (9, 48));
        assert_eq!(file[200..208], (-2.5_f64).to_le_bytes());
        assert_eq!(file.len(), 192 + 48);
    }

    #[test]
    fn texts_become_a_column_of_cells_and_bad_variables_are_refused() {
        let file =
            bytes(&[Variable { name: "outputs", value: Value::Texts(vec!["az", "cable:3@0.5:z", "µ"]) }]).unwrap();
        let text: Vec<u8> = file.iter().copied().filter(|byte| *byte != 0).collect();
        let text = String::from_utf8_lossy(&text).into_owned();
        assert!(text.contains("outputs") && text.contains("cable:3@0.5:z"), "{text}");
        assert_eq!(file.len() % 8, 0);
        for (name, value) in [
            ("1st", Value::Matrix(1, &[1.0][..])),
            ("", Value::Matrix(1, &[1.0])),
            ("a b", Value::Matrix(1, &[1.0])),
            ("a", Value::Matrix(2, &[1.0, 2.0, 3.0])),
        ] {
            let is_nameless = name.is_empty();
            assert_eq!(bytes(&[Variable { name, value }]).is_none(), !is_nameless, "{name}");
        }
    }
}
