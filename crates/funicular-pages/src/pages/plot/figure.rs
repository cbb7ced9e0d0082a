//! One figure of a map or sweep for a paper: the curves of one kind of quantity, or one slice of a grid.

use super::rows::{NOT_COMPUTED, Rows, Series, label, robot_name, with_unit};
use super::{axis_title, brief, curves, refuse_no_rows, status};
use crate::figures::axis::ChartAxis;
use crate::figures::chart::{Chart, Entry, Layer, Panel, Sample};
use crate::figures::map::{ColourBar, ColourScale, Map, limits};
use crate::figures::{Figure, FigureContent, style};
use anyhow::{Result, anyhow, bail};
use funicular::robot::Robot;
use funicular_study::sweep::Quantity;
use funicular_study::table::SweepRows;

/// Choice of what the figure of a map or sweep shows.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SweepFigureChoice {
    /// Name of the quantity, as `tension-max`, or of its column, as `tension_max_n`.
    pub quantity: Option<String>,
    /// Names of the horizontal and the vertical axis of a slice.
    pub plane: Option<[String; 2]>,
    /// Values of the other axes of a slice, by name.
    pub at: Vec<(String, f64)>,
}

/// Figure of rows, with its notes.
pub struct SweepFigure {
    /// The figure.
    pub figure: Figure,
    /// Notes for the user: which slice is drawn, and what the figure leaves out.
    pub notes: Vec<String>,
}

/// Makes the figure of one quantity of a map or sweep. `place` names the rows in messages.
///
/// # Errors
/// A damaged file, a file without rows, several quantities without a choice, or a choice that the rows do not have.
pub fn figure(file: &dyn SweepRows, place: &str, choice: &SweepFigureChoice) -> Result<SweepFigure> {
    refuse_no_rows(file, place)?;
    let rows = Rows::read(file)?;
    let name = robot_name(&file.record().plan);
    let wanted = choice.quantity.as_ref().map(|text| ChosenColumns::of(text, file));
    if rows.axes.len() >= 2 {
        slice(&rows, &name, wanted.as_ref(), choice)
    } else {
        lines(&rows, &name, wanted.as_ref(), choice)
    }
}

/// Columns that a choice of a quantity means.
struct ChosenColumns {
    /// Text of the choice.
    text: String,
    columns: Vec<String>,
}

impl ChosenColumns {
    /// Columns of a quantity such as `tension-max`, or the column with this name.
    fn of(text: &str, file: &dyn SweepRows) -> Self {
        let quantity = text.trim().parse::<Quantity>().ok().zip(Robot::from_toml(&file.record().robot_file).ok());
        let columns = match quantity {
            Some((quantity, robot)) => quantity.columns(&robot).into_iter().map(|column| column.name).collect(),
            None => vec![text.trim().replace('-', "_")],
        };
        Self { text: text.to_owned(), columns }
    }
}

/// Series of the chosen quantity, out of groups that share a figure.
fn chosen<'a>(groups: &[Vec<&'a Series>], wanted: Option<&ChosenColumns>) -> Result<Vec<&'a Series>> {
    let names = |groups: &[Vec<&Series>]| -> String {
        groups.iter().map(|group| group[0].name.as_str()).collect::<Vec<_>>().join(", ")
    };

    let Some(wanted) = wanted else {
        return match groups {
            [] => Err(anyhow!("no row has a value, so there is nothing to draw")),
            [one] => Ok(one.clone()),
            _ => Err(anyhow!(
                "a figure shows one quantity, and the rows have {}: choose it with ⟪quantity⟫",
                names(groups)
            )),
        };
    };

    let found: Vec<Vec<&Series>> = groups
        .iter()
        .map(|group| group.iter().copied().filter(|series| wanted.columns.contains(&series.name)).collect::<Vec<_>>())
        .filter(|group| !group.is_empty())
        .collect();

    match &found[..] {
        [] => Err(anyhow!("⟪quantity⟫: the rows have no numbers of `{}`; they have {}", wanted.text, names(groups))),
        [one] => Ok(one.clone()),
        several => Err(anyhow!(
            "⟪quantity⟫: a figure cannot show all of `{}`; choose one of its columns: {}",
            wanted.text,
            names(several)
        )),
    }
}

/// Curves of one group of quantities.
fn lines(rows: &Rows, name: &str, wanted: Option<&ChosenColumns>, choice: &SweepFigureChoice) -> Result<SweepFigure> {
    if choice.plane.is_some() || !choice.at.is_empty() {
        bail!("these rows have one axis: ⟪plane⟫ and ⟪at⟫ choose a slice of a grid with two or more");
    }
    let mut groups: Vec<(String, Vec<&Series>)> = Vec::new();
    for series in rows.series.iter().filter(|series| series.count > 0) {
        let family = curves::family(series);
        match groups.iter_mut().find(|(known, _)| *known == family) {
            Some((_, members)) => members.push(series),
            None => groups.push((family, vec![series])),
        }
    }
    let groups: Vec<Vec<&Series>> = groups.into_iter().map(|(_, members)| members).collect();
    let members = chosen(&groups, wanted)?;

    let along = curves::horizontal_axis(rows);
    let (from, to) = bounds(along.x.iter().copied());
    let x = ChartAxis::linear(along.title.clone(), from, to);
    let (low, high) = bounds(members.iter().flat_map(|series| series.values.iter().copied()));
    let room = 0.05 * (high - low);
    let y = ChartAxis::linear(curves::vertical_title(&members), low - room, high + room);

    let bands = curves::infeasible_ranges(rows, &along);
    let has_bands = !bands.is_empty();
    let mut layers = vec![Layer::Bands(bands)];
    let mut legend = Vec::new();
    let few = along.x.len() <= MAX_SYMBOLS;
    for (i, series) in members.iter().enumerate() {
        let stroke = style::curve(i);
        let points: Vec<(f64, f64)> = along.x.iter().copied().zip(series.values.iter().copied()).collect();
        let sample =
            if few { Sample::LineAndSymbol(stroke.clone(), style::symbol(i)) } else { Sample::Line(stroke.clone()) };
        if members.len() > 1 {
            legend.push(Entry { text: label(&series.name), sample });
        }
        // Single values between two missing ones have no line.
        let alone: Vec<(f64, f64)> = (0..points.len()).filter(|&k| is_alone(&points, k)).map(|k| points[k]).collect();
        let symbols = if few { points.iter().copied().filter(|(_, y)| y.is_finite()).collect() } else { alone };
        layers.push(Layer::Line { points, stroke });
        layers.push(Layer::Symbols { points: symbols, symbol: style::symbol(i) });
    }
    if has_bands {
        legend.push(Entry { text: "infeasible".to_owned(), sample: Sample::Band });
    }
    let mut notes = Vec::new();
    if rows.shown() < rows.rows {
        notes.push(format!("the figure shows {} of {} rows", rows.shown(), rows.rows));
    }
    let title = format!("{name}: {}", label(&members[0].name));
    let chart = Chart { title, x, panels: vec![Panel::new(y, 0.58, layers)], legend, colour_bar: None };
    Ok(SweepFigure { figure: Figure(FigureContent::Chart(chart)), notes })
}

/// Maximum number of rows at which every value has a symbol.
const MAX_SYMBOLS: usize = 25;

fn is_alone(points: &[(f64, f64)], k: usize) -> bool {
    let there = |k: Option<usize>| k.and_then(|k| points.get(k)).is_some_and(|(_, y)| y.is_finite());
    there(Some(k)) && !there(k.checked_sub(1)) && !there(Some(k + 1))
}

fn bounds(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
}

/// Slice of a grid.
fn slice(rows: &Rows, name: &str, wanted: Option<&ChosenColumns>, choice: &SweepFigureChoice) -> Result<SweepFigure> {
    let groups: Vec<Vec<&Series>> =
        rows.series.iter().filter(|series| series.count > 0).map(|series| vec![series]).collect();
    let series = chosen(&groups, wanted)?[0];
    let (h, v) = plane(rows, choice)?;
    let at = places(rows, choice, [h, v])?;

    let notes = slice_notes(rows, choice, [h, v], &at)?;
    let (x, y) = (rows.axes[h].values(), rows.axes[v].values());
    let cells = slice_cells(rows, [h, v], &at);
    let values: Vec<f64> = cells.iter().map(|&cell| series.values[cell]).collect();
    let infeasible: Vec<bool> = cells
        .iter()
        .map(|&cell| rows.status[cell] != NOT_COMPUTED && status(rows.status[cell]).1.starts_with("infeasible"))
        .collect();
    let Some(scale) = ColourScale::of(&values) else {
        bail!("the slice has no value of {}: choose another with ⟪at⟫", label(&series.name));
    };

    let title = with_unit(&label(&series.name), &series.unit);
    let axis = |k: usize, values: &[f64]| {
        let (low, high) = limits(values);
        ChartAxis::linear(axis_title(&rows.axes[k].name, &rows.axes[k].unit), low, high)
    };
    let (x_axis, y_axis) = (axis(h, &x), axis(v, &y));
    let ratio = (y_axis.high - y_axis.low) / (x_axis.high - x_axis.low);
    let lengths = rows.axes[h].unit == "m" && rows.axes[v].unit == "m";
    let equal_scales = lengths && (0.25..4.0).contains(&ratio);
    let mut legend = Vec::new();
    if infeasible.iter().any(|is| *is) {
        legend.push(Entry { text: "infeasible".to_owned(), sample: Sample::Hatch });
    }
    let map = Map { x, y, values, infeasible, scale: scale.clone() };
    let panel = Panel { equal_scales, ..Panel::new(y_axis, 0.6, vec![Layer::Map(Box::new(map))]) };
    let chart = Chart {
        title: format!("{name}: {}", label(&series.name)),
        x: x_axis,
        panels: vec![panel],
        legend,
        colour_bar: Some(ColourBar { title, scale }),
    };
    Ok(SweepFigure { figure: Figure(FigureContent::Chart(chart)), notes })
}

/// Sentences about what the slice does not show: places on the other axes that the user has not given, and values that
/// are left out.
fn slice_notes(rows: &Rows, choice: &SweepFigureChoice, [h, v]: [usize; 2], at: &[usize]) -> Result<Vec<String>> {
    let mut notes = Vec::new();
    let mut given = Vec::new();
    for (name, _) in &choice.at {
        given.push(axis_of(rows, "at", name)?);
    }
    for (k, axis) in rows.axes.iter().enumerate().filter(|(k, _)| *k != h && *k != v && !given.contains(k)) {
        let unit = if axis.unit == "1" { String::new() } else { format!(" {}", axis.unit) };
        notes.push(format!(
            "the slice at {} = {}{unit} is drawn; ⟪at⟫ chooses another",
            axis.name,
            brief(axis.values()[at[k]])
        ));
    }
    let thinned = rows.axes.iter().filter(|axis| axis.every > 1);
    let thinned: Vec<String> =
        thinned.map(|axis| format!("{} of {} values of {}", axis.kept(), axis.steps.count(), axis.name)).collect();
    if !thinned.is_empty() {
        notes.push(format!("the figure shows {}, to limit its size", thinned.join(", ")));
    }
    Ok(notes)
}

/// Cells of the slice, row by row upwards, at these places on the other axes.
fn slice_cells(rows: &Rows, [h, v]: [usize; 2], at: &[usize]) -> Vec<usize> {
    let mut strides = vec![1; rows.axes.len()];
    for k in 1..strides.len() {
        strides[k] = strides[k - 1] * rows.axes[k - 1].kept();
    }
    let base: usize = (0..rows.axes.len()).filter(|k| *k != h && *k != v).map(|k| at[k] * strides[k]).sum();
    (0..rows.axes[v].kept())
        .flat_map(|j| (0..rows.axes[h].kept()).map(move |i| (i, j)))
        .map(|(i, j)| base + i * strides[h] + j * strides[v])
        .collect()
}

/// Axes of the slice: the chosen ones, or the two with most cells, in the order of the file.
fn plane(rows: &Rows, choice: &SweepFigureChoice) -> Result<(usize, usize)> {
    let Some([h, v]) = &choice.plane else {
        let n = rows.axes.len();
        let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
        // The first of equal pairs counts; `max_by_key` returns the last.
        let cells = |(i, j): &(usize, usize)| rows.axes[*i].kept() * rows.axes[*j].kept();
        return pairs.rev().max_by_key(cells).ok_or_else(|| anyhow!("a slice needs two axes"));
    };
    let (h, v) = (axis_of(rows, "plane", h)?, axis_of(rows, "plane", v)?);
    if h == v {
        bail!("⟪plane⟫ names {} twice: a slice has two different axes", rows.axes[h].name);
    }
    Ok((h, v))
}

/// Index of an axis by its name.
fn axis_of(rows: &Rows, key: &str, name: &str) -> Result<usize> {
    let names: Vec<&str> = rows.axes.iter().map(|axis| axis.name.as_str()).collect();
    names.iter().position(|known| *known == name.trim()).ok_or_else(|| {
        anyhow!("⟪{key}⟫: `{name}` is not an axis of these rows; the axes that vary are {}", names.join(", "))
    })
}

/// Position of the slice on every axis: the chosen values, the middle elsewhere.
fn places(rows: &Rows, choice: &SweepFigureChoice, plane: [usize; 2]) -> Result<Vec<usize>> {
    /// Maximum distance of a chosen value from a value of the grid, relative to the range of the axis.
    const NEAR: f64 = 1e-6;

    let mut at: Vec<usize> = rows.axes.iter().map(|axis| (axis.kept() - 1) / 2).collect();

    for (name, wanted) in &choice.at {
        let k = axis_of(rows, "at", name)?;
        if plane.contains(&k) {
            bail!("⟪at⟫: {name} is an axis of the slice itself; the slice shows all its values");
        }

        let values = rows.axes[k].values();
        let range = values[values.len() - 1] - values[0];
        let distance = |value: f64| (value - wanted).abs();
        let nearest = (0..values.len()).min_by(|&i, &j| distance(values[i]).total_cmp(&distance(values[j])));
        let nearest = nearest.unwrap_or_default();

        if distance(values[nearest]) > NEAR * range {
            let near: Vec<String> =
                values[nearest.saturating_sub(1)..(nearest + 2).min(values.len())].iter().map(|v| brief(*v)).collect();
            bail!("⟪at⟫: {name} = {wanted} is not a value of these rows; the nearest values are {}", near.join(", "));
        }

        at[k] = nearest;
    }

    Ok(at)
}
