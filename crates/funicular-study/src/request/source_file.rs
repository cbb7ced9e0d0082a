//! Files of other programs as a request contains them: decoded to text.

use crate::text::clean;
use anyhow::{Context, Result, bail};
use encoding_rs::{Encoding, UTF_8, UTF_16BE, UTF_16LE, WINDOWS_1252};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Maximum size of a file [bytes]. A cable takes about 500 bytes of XML, so a larger file was given by mistake.
pub const MAX_BYTES: usize = 16 << 20;

/// File of another program, decoded to text.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SourceFile {
    /// Path of the file as the user wrote it, for messages.
    pub path: String,
    /// Text of the file.
    pub text: String,
    /// Name of the encoding, if it had to be guessed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub guessed_encoding: Option<String>,
}

impl SourceFile {
    /// Decodes a file. The encoding is given by a byte-order mark, otherwise by the XML declaration, unless its bytes
    /// cannot be what it says. Without either it is UTF-8 if the bytes are valid UTF-8, and windows-1252 otherwise,
    /// which western European Windows programs write.
    ///
    /// # Errors
    /// A file that is too large, or that is no text in its encoding.
    pub fn decode(path: String, bytes: &[u8]) -> Result<Self> {
        if bytes.len() > MAX_BYTES {
            bail!("{path} is larger than {} MiB, the limit for the file of one robot", MAX_BYTES >> 20);
        }

        let by_bytes = Encoding::for_bom(bytes).map(|(encoding, _)| encoding).or_else(|| unmarked_utf16(bytes));
        let (encoding, guessed) = match (by_bytes, declared_encoding(bytes)) {
            (Some(encoding), _) => (encoding, None),
            (None, Some(label)) => {
                let declared = Encoding::for_label(label.as_bytes())
                    .with_context(|| format!("{path}: its encoding `{label}` is unknown; save it as UTF-8"))?;
                // A declaration that was read byte by byte is not in UTF-16, whatever it says: programs that write a
                // text of UTF-16 to a file in another encoding leave it so.
                if declared == UTF_16LE || declared == UTF_16BE { of_bytes(bytes) } else { (declared, None) }
            }
            (None, None) => of_bytes(bytes),
        };

        let (text, _, broken) = encoding.decode(bytes);
        if broken {
            bail!("{path} is no text in {}, the encoding that it declares; save it as UTF-8", encoding.name());
        }

        if let Some(at) = text.find('\0') {
            bail!("{path} is no text: character {} is zero", at + 1);
        }

        Ok(Self { path, text: text.into_owned(), guessed_encoding: guessed })
    }

    /// File name without folders, for use in the robot file.
    pub fn name(&self) -> String {
        let name = Path::new(&self.path).file_name().map_or(self.path.clone().into(), std::ffi::OsStr::to_string_lossy);
        clean(&name)
    }

    /// File name without folders and ending.
    pub fn stem(&self) -> String {
        let name = self.name();
        Path::new(&name).file_stem().map_or_else(|| name.clone(), |stem| stem.to_string_lossy().into_owned())
    }

    /// Note on a guessed encoding, if there was one.
    pub fn caveat(&self) -> Option<String> {
        self.guessed_encoding.as_ref().map(|name| {
            format!("{} is not UTF-8 and declares no encoding that fits; it was read as {name}", self.name())
        })
    }
}

/// UTF-16 without a byte-order mark, by the first letter of an XML file.
fn unmarked_utf16(bytes: &[u8]) -> Option<&'static Encoding> {
    match bytes {
        [b'<', 0, ..] => Some(UTF_16LE),
        [0, b'<', ..] => Some(UTF_16BE),
        _ => None,
    }
}

/// Encoding that fits the bytes of a file that does not declare one, with its name if it is a guess.
fn of_bytes(bytes: &[u8]) -> (&'static Encoding, Option<String>) {
    match std::str::from_utf8(bytes) {
        Ok(_) => (UTF_8, None),
        Err(_) => (WINDOWS_1252, Some(WINDOWS_1252.name().to_owned())),
    }
}

/// Encoding declared by `<?xml … encoding="…"?>`.
fn declared_encoding(bytes: &[u8]) -> Option<String> {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(200)]);
    let declaration = head.trim_start().strip_prefix("<?xml")?.split_once("?>")?.0;
    let value = declaration.split_once("encoding")?.1.trim_start().strip_prefix('=')?.trim_start();
    let quote = value.chars().next().filter(|c| matches!(c, '"' | '\''))?;
    Some(value[1..].split_once(quote)?.0.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decoded(bytes: &[u8]) -> SourceFile {
        SourceFile::decode("a.xml".to_owned(), bytes).unwrap()
    }

    #[test]
    fn text_is_decoded_by_mark_then_declaration_then_guess() {
        let utf16: Vec<u8> = [0xFEFF].into_iter().chain("<ä/>".encode_utf16()).flat_map(u16::to_le_bytes).collect();
        assert_eq!(decoded(&utf16).text, "<ä/>");
        assert_eq!(decoded(b"\xEF\xBB\xBF<a/>").text, "<a/>");
        assert!(decoded(b"<?xml version='1.0' encoding='ISO-8859-1'?><a n='\xE4'/>").text.ends_with("<a n='ä'/>"));
        let guessed = decoded(b"<a n='\xE4'/>");
        assert_eq!(guessed.text, "<a n='ä'/>");
        assert!(guessed.caveat().unwrap().contains("windows-1252"));
        assert!(decoded("<a n='ä'/>".as_bytes()).caveat().is_none());
        // Programs on Windows declare the encoding of their strings, and write another.
        for label in ["utf-16", "UTF-16LE", "utf-16be", "unicode"] {
            let text = format!("<?xml version='1.0' encoding='{label}'?><a n='ä'/>");
            assert_eq!(decoded(text.as_bytes()).text, text);
            let unmarked: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
            assert_eq!(decoded(&unmarked).text, text);
        }
        let latin = decoded(b"<?xml encoding='utf-16'?><a n='\xE4'/>");
        assert!(latin.caveat().is_some() && latin.text.ends_with("<a n='ä'/>"));
    }

    #[test]
    fn bytes_that_are_no_text_are_refused() {
        for (bytes, expected) in [
            (&b"<?xml encoding=\"utf-8\"?>\xFF"[..], "no text in UTF-8"),
            (b"<?xml encoding=\"klingon\"?>", "`klingon` is unknown"),
            (b"<a>\0</a>", "character 4 is zero"),
        ] {
            let error = SourceFile::decode("a.xml".to_owned(), bytes).err().unwrap().to_string();
            assert!(error.contains(expected), "{error}");
        }
    }
}
