//! Reader of Universal Files: datasets 58 and 58b (functions), 15 and 2411 (nodes), 55 (mode shapes), 151 (header) and
//! 164 (units). Other datasets are skipped.
//!
//! A dataset stands between two lines `    -1`. The body of a 58b is binary; it is passed by its number of bytes,
//! because it may contain any bytes.

use super::check_size;
use super::uff_numbers::{Line, Lines, is_delimiter};
use anyhow::{Context, Result, anyhow, bail};
use funicular::math::Complex;
use std::collections::BTreeMap;

/// Number of nodal values of a mode shape's node that are read: a dataset 55 has at most this many per node.
const MAX_VALUES_PER_NODE: i64 = 6;

/// Contents of a Universal File.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct UffFile {
    /// Name of the model from dataset 151, if there is one.
    pub model: Option<String>,
    /// Units of all numbers.
    pub units: Units,
    /// Nodes with their coordinates in the unit of the file.
    pub nodes: BTreeMap<i64, [f64; 3]>,
    /// Functions.
    pub functions: Vec<Function>,
    /// Mode shapes.
    pub shapes: Vec<Shape>,
    /// Types of other datasets, with their numbers of occurrence.
    pub skipped: BTreeMap<String, usize>,
}

/// Factors of dataset 164 by which a number of the file is divided to be in SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Units {
    /// Factor of lengths.
    pub length: f64,
    /// Factor of forces.
    pub force: f64,
    /// True if the file gives them; without a dataset 164 a file is in SI units.
    pub given: bool,
}

impl Units {
    /// True if the factors are not those of SI units.
    pub fn converts(&self) -> bool {
        [self.length, self.force].iter().any(|factor| (factor - 1.0).abs() > f64::EPSILON)
    }
}

impl Default for Units {
    fn default() -> Self {
        Self { length: 1.0, force: 1.0, given: false }
    }
}

/// Node and direction of a response or of a force.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct NodeDirection {
    /// Number of the node.
    pub node: i64,
    /// Direction: ±1, ±2, ±3 along x, y, z; ±4, ±5, ±6 about x, y, z; 0 for a scalar.
    pub direction: i64,
}

/// One of the axes of a function.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct UffAxis {
    /// Specific data type: 8 displacement, 11 velocity, 12 acceleration, 13 force, 17 time, 18 frequency.
    pub kind: i64,
    /// Label.
    pub label: String,
    /// Label of the unit.
    pub unit: String,
}

/// Function of dataset 58 or 58b.
#[derive(Debug, Clone, PartialEq)]
pub struct Function {
    /// Line of its dataset's type, from 1; messages and names of functions have the next line.
    pub line: usize,
    /// Five lines of text.
    pub texts: [String; 5],
    /// Type of function: 1 time response, 4 frequency response, …
    pub kind: i64,
    /// Response.
    pub response: NodeDirection,
    /// Reference.
    pub reference: NodeDirection,
    /// Abscissae, in the unit of the file.
    pub abscissae: Vec<f64>,
    /// Ordinates, in the unit of the file; real ones have an imaginary part of zero.
    pub values: Vec<Complex>,
    /// True if the ordinates are complex.
    pub is_complex: bool,
    /// Axis of the abscissae.
    pub abscissa: UffAxis,
    /// Axis of the ordinates, or of their numerator.
    pub numerator: UffAxis,
    /// Axis of the ordinates' denominator.
    pub denominator: UffAxis,
}

/// Mode shape of dataset 55.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// Line of its dataset, from 1.
    pub line: usize,
    /// Frequency [Hz].
    pub frequency_hz: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
    /// Values of each node.
    pub values: BTreeMap<i64, Vec<Complex>>,
}

impl UffFile {
    /// Reads the bytes of a file; `path` is its name in messages.
    ///
    /// # Errors
    /// A file that is too large or no Universal File, or a dataset that is cut off or has a wrong number, with the
    /// line.
    pub fn read(path: &str, bytes: &[u8]) -> Result<Self> {
        check_size(path, bytes.len())?;
        let mut file = Self::default();
        let mut lines = Lines::new(bytes);
        let mut found_any = false;
        while let Some(line) = lines.next() {
            if is_delimiter(line) {
                found_any = true;
                file.dataset(&mut lines).with_context(|| path.to_owned())?;
            }
        }
        if !found_any {
            bail!("{path} is no Universal File: it has no line `    -1`, with which every dataset begins");
        }
        Ok(file)
    }

    /// Reads a dataset from the line of its type on, up to its closing line.
    fn dataset(&mut self, lines: &mut Lines<'_>) -> Result<()> {
        let Some(bytes) = lines.next() else { return Ok(()) };
        let line = Line { bytes, number: lines.number };
        let kind = line.text(0, 7);

        match kind.as_str() {
            "58" | "58b" | "58B" => {
                let function = if kind == "58" { function(lines, None)? } else { function(lines, Some(&line))? };
                self.functions.push(function);
                close(lines, 58)
            }

            "15" => self.nodes_15(lines),
            "2411" => self.nodes_2411(lines),
            "55" => self.shape(lines),

            "151" => {
                let model = lines.expect("the name of the model (dataset 151)")?;
                self.model = Some(model.text(0, 80)).filter(|model| !model.is_empty());
                skip(lines)
            }

            "164" => {
                lines.expect("the code of the units (dataset 164)")?;
                let factors = lines.expect("the factors of the units (dataset 164)")?;
                let (length, force) = (factors.real(0, 25)?, factors.real(25, 50)?);
                if !(length > 0.0 && force > 0.0) {
                    bail!(
                        "line {}: the factors {length} of lengths and {force} of forces (dataset 164) must be positive",
                        factors.number
                    );
                }
                self.units = Units { length, force, given: true };
                skip(lines)
            }

            _ => {
                *self.skipped.entry(line.text(0, 80)).or_default() += 1;
                skip(lines)
            }
        }
    }

    /// Nodes of dataset 15: one line each.
    fn nodes_15(&mut self, lines: &mut Lines<'_>) -> Result<()> {
        loop {
            let line = lines.expect("a node or the end of dataset 15")?;
            if is_delimiter(line.bytes) {
                return Ok(());
            }
            let at = [line.real(40, 53)?, line.real(53, 66)?, line.real(66, 79)?];
            self.nodes.insert(line.whole(0, 10)?, at);
        }
    }

    /// Nodes of dataset 2411: two lines each.
    fn nodes_2411(&mut self, lines: &mut Lines<'_>) -> Result<()> {
        loop {
            let line = lines.expect("a node or the end of dataset 2411")?;
            if is_delimiter(line.bytes) {
                return Ok(());
            }
            let place = lines.expect("the coordinates of a node (dataset 2411)")?;
            let at = [place.real(0, 25)?, place.real(25, 50)?, place.real(50, 75)?];
            self.nodes.insert(line.whole(0, 10)?, at);
        }
    }

    /// Mode shape of dataset 55. Other data at nodes are skipped.
    fn shape(&mut self, lines: &mut Lines<'_>) -> Result<()> {
        let first = lines.number;
        for _ in 0..5 {
            lines.expect("a line of text (dataset 55)")?;
        }
        let kinds = lines.expect("the kinds of the data (dataset 55)")?;
        let (analysis, data, count) = (kinds.whole(10, 20)?, kinds.whole(40, 50)?, kinds.whole(50, 60)?);
        // Normal modes, complex modes of first and of second order.
        if !matches!(analysis, 2 | 3 | 7) || !matches!(data, 2 | 5) {
            *self.skipped.entry(format!("55 (analysis {analysis}, data {data})")).or_default() += 1;
            return skip(lines);
        }
        if !(1..=MAX_VALUES_PER_NODE).contains(&count) {
            bail!("line {}: {count} values per node (dataset 55), it must be 1 to {MAX_VALUES_PER_NODE}", kinds.number);
        }

        lines.expect("the numbers of the mode (dataset 55)")?;
        let numbers = lines.expect("frequency and damping (dataset 55)")?;
        let (frequency_hz, damping_ratio) = if analysis == 2 {
            (numbers.real(0, 13)?, numbers.real(26, 39)?)
        } else {
            // Real and imaginary part of the eigenvalue [rad/s].
            let eigenvalue = Complex::new(numbers.real(0, 13)?, numbers.real(13, 26)?);
            let omega = eigenvalue.norm();
            (omega / std::f64::consts::TAU, if omega > 0.0 { -eigenvalue.re / omega } else { 0.0 })
        };

        let mut values = BTreeMap::new();
        let numbers = count as usize * if data == 5 { 2 } else { 1 };
        loop {
            let line = lines.expect("a node or the end of dataset 55")?;
            if is_delimiter(line.bytes) {
                break;
            }
            let node = line.whole(0, 10)?;
            let mut of_node = Vec::with_capacity(numbers);
            while of_node.len() < numbers {
                let line = lines.expect("values of a node (dataset 55)")?;
                for field in 0..6.min(numbers - of_node.len()) {
                    of_node.push(line.real(13 * field, 13 * field + 13)?);
                }
            }
            values.insert(node, complex_of(&of_node, data == 5));
        }
        self.shapes.push(Shape { line: first, frequency_hz, damping_ratio, values });
        Ok(())
    }
}

/// Complex numbers of a list of real ones, or of pairs of real and imaginary part.
fn complex_of(numbers: &[f64], is_complex: bool) -> Vec<Complex> {
    if is_complex {
        numbers.chunks_exact(2).map(|pair| Complex::new(pair[0], pair[1])).collect()
    } else {
        numbers.iter().map(|number| Complex::new(*number, 0.0)).collect()
    }
}

/// Skips lines up to the end of a dataset. A dataset that the file cuts off is none that anybody needs.
fn skip(lines: &mut Lines<'_>) -> Result<()> {
    loop {
        if is_delimiter(lines.expect("the end `    -1` of a dataset")?.bytes) {
            return Ok(());
        }
    }
}

/// Reads the closing line of a dataset; blank lines may stand before it.
fn close(lines: &mut Lines<'_>, dataset: u32) -> Result<()> {
    loop {
        let line = lines.expect(&format!("the end `    -1` of dataset {dataset}"))?;
        if is_delimiter(line.bytes) {
            return Ok(());
        }
        if !line.is_blank_from(0) {
            bail!(
                "line {}: dataset {dataset} goes on after its last point; its number of points is too small",
                line.number
            );
        }
    }
}

/// Form of the ordinates.
struct OrdinateForm {
    is_complex: bool,
    is_double: bool,
    is_even: bool,
    points: usize,
    first: f64,
    step: f64,
}

impl OrdinateForm {
    /// Numbers per point, abscissa included.
    fn per_point(&self) -> usize {
        usize::from(!self.is_even) + if self.is_complex { 2 } else { 1 }
    }

    /// Function values of the numbers in the order of the file.
    fn split(&self, numbers: &[f64]) -> (Vec<f64>, Vec<Complex>) {
        let skip = usize::from(!self.is_even);
        let points = numbers.chunks_exact(self.per_point());
        let abscissae = points
            .clone()
            .enumerate()
            .map(|(i, point)| if self.is_even { self.first + i as f64 * self.step } else { point[0] });
        let value = |point: &[f64]| Complex::new(point[skip], if self.is_complex { point[skip + 1] } else { 0.0 });
        (abscissae.collect(), points.map(value).collect())
    }
}

/// Reads a function from its first line of text to its last point. `binary` is the line of the type of a 58b.
fn function(lines: &mut Lines<'_>, binary: Option<&Line<'_>>) -> Result<Function> {
    let first = lines.number;
    let mut texts: [String; 5] = Default::default();
    for text in &mut texts {
        *text = lines.expect("a line of text (dataset 58)")?.text(0, 80);
    }

    let ends = lines.expect("the nodes of the function (dataset 58)")?;
    let kind = ends.whole(0, 5)?;
    let response = NodeDirection { node: ends.whole(41, 51)?, direction: ends.whole(51, 55)? };
    let reference = NodeDirection { node: ends.whole(66, 76)?, direction: ends.whole(76, 80)? };

    let line = lines.expect("the form of the data (dataset 58)")?;
    let ordinates = line.whole(0, 10)?;
    if !matches!(ordinates, 2 | 4 | 5 | 6) {
        bail!(
            "line {}: ordinates of type {ordinates} (dataset 58), it must be 2 or 4 (real) or 5 or 6 (complex)",
            line.number
        );
    }
    let points = usize::try_from(line.whole(10, 20)?)
        .map_err(|_| anyhow!("line {}: a negative number of points (dataset 58)", line.number))?;
    let form = OrdinateForm {
        is_complex: ordinates >= 5,
        is_double: matches!(ordinates, 4 | 6),
        is_even: line.whole(20, 30)? == 1,
        points,
        first: line.real(30, 43)?,
        step: line.real(43, 56)?,
    };
    let mut axis = |what: &str| -> Result<UffAxis> {
        let line = lines.expect(what)?;
        Ok(UffAxis { kind: line.whole(0, 10)?, label: line.text(26, 46), unit: line.text(47, 67) })
    };
    let abscissa = axis("the abscissa (dataset 58)")?;
    let numerator = axis("the ordinate (dataset 58)")?;
    let denominator = axis("the denominator of the ordinate (dataset 58)")?;
    axis("the third axis (dataset 58)")?;

    let numbers = match binary {
        None => ascii_numbers(lines, &form)?,
        Some(head) => binary_numbers(lines, &form, head)?,
    };
    let (abscissae, values) = form.split(&numbers);
    Ok(Function {
        line: first,
        texts,
        kind,
        response,
        reference,
        abscissae,
        values,
        is_complex: form.is_complex,
        abscissa,
        numerator,
        denominator,
    })
}

/// Numbers of a text body, by columns. Single ordinates have 13 columns and double ones 20; abscissae always have 13.
fn ascii_numbers(lines: &mut Lines<'_>, form: &OrdinateForm) -> Result<Vec<f64>> {
    // Widths of the fields of a line.
    let widths: &[usize] = match (form.is_even, form.is_complex, form.is_double) {
        (_, _, false) => &[13; 6],
        (true, _, true) => &[20; 4],
        (false, false, true) => &[13, 20, 13, 20],
        (false, true, true) => &[13, 20, 20],
    };

    let total = form.points.saturating_mul(form.per_point());
    let mut numbers = Vec::new();
    while numbers.len() < total {
        let line = lines.expect("a line of points (dataset 58)")?;
        if is_delimiter(line.bytes) {
            bail!("line {}: dataset 58 ends after {} of its {total} numbers", line.number, numbers.len());
        }
        let mut from = 0;
        for width in widths.iter().take(total - numbers.len()) {
            // A line may have fewer numbers than fit into it, but at least one.
            if from > 0 && line.is_blank_from(from) {
                break;
            }
            numbers.push(line.real(from, from + width)?);
            from += width;
        }
        if numbers.len() == total && !line.is_blank_from(from) {
            bail!("line {}: dataset 58 goes on after its last point; its number of points is too small", line.number);
        }
    }
    Ok(numbers)
}

/// Numbers of a binary body.
fn binary_numbers(lines: &mut Lines<'_>, form: &OrdinateForm, head: &Line<'_>) -> Result<Vec<f64>> {
    let (order, format, texts) = (head.whole(7, 13)?, head.whole(13, 19)?, head.whole(19, 31)?);
    if !matches!(order, 1 | 2) {
        bail!("line {}: byte order {order} (dataset 58b), it must be 1 (little endian) or 2 (big endian)", head.number);
    }
    if format != 2 {
        bail!("line {}: numbers of format {format} (dataset 58b); only IEEE numbers, format 2, are read", head.number);
    }
    if texts != 11 {
        bail!("line {}: {texts} lines before the binary data (dataset 58b), it must be 11", head.number);
    }
    let declared = usize::try_from(head.whole(31, 43)?)
        .map_err(|_| anyhow!("line {}: a negative number of bytes (dataset 58b)", head.number))?;

    // Uneven abscissae of double ordinates are single numbers by the format, and double ones by some programs.
    let ordinates = form.per_point() - usize::from(!form.is_even);
    let wide = if form.is_double { 8 } else { 4 };
    let abscissa_sizes: &[usize] = match (form.is_even, form.is_double) {
        (true, _) => &[0],
        (false, false) => &[4],
        (false, true) => &[8, 4],
    };
    let size_with = |abscissa: usize| form.points.checked_mul(ordinates * wide + abscissa);
    // The size follows from the number of points and their form. The number of bytes in the file only says how wide the
    // abscissae are, because some programs count other bytes; where it does not fit, the closing line decides.
    let fits = |abscissa: &&usize| size_with(**abscissa) == Some(declared);
    let closes = |abscissa: &&usize| size_with(**abscissa).is_some_and(|size| lines.closes_after(size));
    let Some(abscissa) = abscissa_sizes.iter().find(fits).or_else(|| abscissa_sizes.iter().find(closes)) else {
        // A body that is cut off is told first.
        lines.take(declared)?;
        bail!(
            "line {}: {declared} bytes of binary data do not hold {} points of {} numbers of {wide} bytes, and no line \
             `    -1` stands behind such points (dataset 58b)",
            head.number,
            form.points,
            form.per_point()
        )
    };
    let size = size_with(*abscissa).unwrap_or_default();
    let body = lines.take(size)?;
    lines.skip_line_end();

    let little = order == 1;
    let mut numbers = Vec::with_capacity(size / 4);
    for point in body.chunks_exact(ordinates * wide + abscissa) {
        let (x, y) = point.split_at(*abscissa);
        let parts = (!x.is_empty()).then_some(x).into_iter().chain(y.chunks_exact(wide));
        for part in parts {
            let number = ieee(part, little);
            if !number.is_finite() {
                bail!("line {}: a number in the binary data is not finite (dataset 58b)", head.number);
            }
            numbers.push(number);
        }
    }
    Ok(numbers)
}

/// IEEE number of four or eight bytes.
fn ieee(bytes: &[u8], little: bool) -> f64 {
    match (<[u8; 4]>::try_from(bytes), <[u8; 8]>::try_from(bytes)) {
        (Ok(four), _) => f64::from(if little { f32::from_le_bytes(four) } else { f32::from_be_bytes(four) }),
        (_, Ok(eight)) => {
            if little {
                f64::from_le_bytes(eight)
            } else {
                f64::from_be_bytes(eight)
            }
        }
        _ => f64::NAN,
    }
}
