//! Reading of XML with errors that name file, line, element and value.

use super::text;
use anyhow::{Error, Result, anyhow, bail};
use funicular::math::Vec3;
use funicular_study::request::SourceFile;
use roxmltree::{Document, Node, ParsingOptions};

/// Maximum number of elements, attributes and texts together; a robot with 100 cables has about 5000.
const MAX_NODES: u32 = 1_000_000;

/// Parsed XML file.
pub(crate) struct Xml<'a> {
    file: &'a SourceFile,
    document: Document<'a>,
}

impl<'a> Xml<'a> {
    /// Parses a file. A document type declaration is ignored: nothing is fetched, and the expansion of entities is
    /// limited.
    pub(crate) fn parse(file: &'a SourceFile) -> Result<Self> {
        let options = ParsingOptions { allow_dtd: true, nodes_limit: MAX_NODES, ..ParsingOptions::default() };
        let document = Document::parse_with_options(&file.text, options).map_err(|error| {
            let at = error.pos();
            let message = error.to_string();
            let message = message.strip_suffix(&format!(" at {at}")).unwrap_or(&message);
            anyhow!("{}:{}:{}: the file is not well-formed XML: {message}", file.path, at.row, at.col)
        })?;
        Ok(Self { file, document })
    }

    pub(crate) fn file(&self) -> &'a SourceFile {
        self.file
    }

    pub(crate) fn path(&self) -> &str {
        &self.file.path
    }

    pub(crate) fn root(&self) -> Node<'_, 'a> {
        self.document.root_element()
    }

    pub(crate) fn root_name(&self) -> &str {
        self.root().tag_name().name()
    }

    /// `file:line:column` of an element.
    pub(crate) fn place(&self, node: Node) -> String {
        let at = self.document.text_pos_at(node.range().start);
        format!("{}:{}:{}", self.file.path, at.row, at.col)
    }

    /// Error located at an element.
    pub(crate) fn error(&self, node: Node, message: impl std::fmt::Display) -> Error {
        anyhow!("{}: {message}", self.place(node))
    }

    /// Only child with this name, or `None`.
    pub(crate) fn optional<'n>(&self, parent: Node<'n, 'a>, name: &str) -> Result<Option<Node<'n, 'a>>> {
        let mut found = children(parent, name);
        let first = found.next();
        if let Some(second) = found.next() {
            return Err(self.error(second, format!("<{}> has a second <{name}>; keep one", tag(parent))));
        }
        Ok(first)
    }

    /// Only child with this name.
    pub(crate) fn required<'n>(&self, parent: Node<'n, 'a>, name: &str) -> Result<Node<'n, 'a>> {
        self.optional(parent, name)?.ok_or_else(|| self.error(parent, format!("<{}> has no <{name}>", tag(parent))))
    }

    /// Text of an attribute.
    pub(crate) fn attribute<'n>(&self, node: Node<'n, 'a>, name: &str) -> Result<&'n str> {
        node.attribute(name).ok_or_else(|| self.error(node, format!("<{}> has no attribute `{name}`", tag(node))))
    }

    /// Number in an attribute, or `None` if the attribute is missing.
    pub(crate) fn optional_attribute_number(&self, node: Node, name: &str) -> Result<Option<f64>> {
        node.attribute(name).map(|text| self.number_in(node, name, text)).transpose()
    }

    /// Number in an attribute.
    pub(crate) fn attribute_number(&self, node: Node<'_, 'a>, name: &str) -> Result<f64> {
        let text = self.attribute(node, name)?;
        self.number_in(node, name, text)
    }

    fn number_in(&self, node: Node, name: &str, text: &str) -> Result<f64> {
        text::number(text)
            .map_err(|wrong| self.error(node, format!("attribute `{name}` of <{}> is {wrong}", tag(node))))
    }

    /// Vector of the attributes `x`, `y` and `z`.
    pub(crate) fn attribute_vector(&self, node: Node<'_, 'a>) -> Result<Vec3> {
        Ok(Vec3::new(
            self.attribute_number(node, "x")?,
            self.attribute_number(node, "y")?,
            self.attribute_number(node, "z")?,
        ))
    }

    /// Number between the tags of an element.
    pub(crate) fn number(&self, node: Node) -> Result<f64> {
        text::number(&content(node)).map_err(|wrong| self.error(node, format!("<{}> is {wrong}", tag(node))))
    }

    /// Number between the tags of the only child with this name.
    pub(crate) fn child_number(&self, parent: Node<'_, 'a>, name: &str) -> Result<f64> {
        self.number(self.required(parent, name)?)
    }

    /// Three numbers between the tags of an element.
    pub(crate) fn vector(&self, node: Node) -> Result<Vec3> {
        let content = content(node);
        let numbers =
            text::numbers(&content).map_err(|wrong| self.error(node, format!("<{}> holds {wrong}", tag(node))))?;
        match numbers[..] {
            [x, y, z] => Ok(Vec3::new(x, y, z)),
            _ => {
                bail!(self.error(node, format!("<{}> holds {} numbers; it must hold three", tag(node), numbers.len())))
            }
        }
    }

    /// Three numbers between the tags of the only child with this name.
    pub(crate) fn child_vector(&self, parent: Node<'_, 'a>, name: &str) -> Result<Vec3> {
        self.vector(self.required(parent, name)?)
    }
}

/// Name of an element, for messages.
pub(crate) fn tag<'n>(node: Node<'n, '_>) -> &'n str {
    node.tag_name().name()
}

/// Children with this name.
pub(crate) fn children<'n, 'a: 'n>(parent: Node<'n, 'a>, name: &str) -> impl Iterator<Item = Node<'n, 'a>> {
    parent.children().filter(move |child| child.is_element() && child.tag_name().name() == name)
}

/// All text between the tags, without comments.
pub(crate) fn content(node: Node) -> String {
    node.children().filter_map(|child| if child.is_text() { child.text() } else { None }).collect()
}
