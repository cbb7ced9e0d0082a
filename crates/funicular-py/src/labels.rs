//! Labels of tables and series (pandas, polars, pyarrow): a labelled number is taken by its name or refused, because
//! its place may be another one than that of an array.

use crate::elements::{Unusable, has_method, read, short};
use funicular_study::units;
use numpy::ndarray::ArrayD;
use pyo3::prelude::*;
use pyo3::types::{PyInt, PyString};

/// Names of the numbers of a row, each in all its spellings, the first of which stands in messages.
#[derive(Debug, Clone)]
pub(crate) struct Names(Vec<Vec<String>>);

impl Names {
    /// Components of an argument that is a vector, such as `force_n`: `x_n`, `x`, `force_x_n`, `fx`.
    pub(crate) fn of_components(argument: &str, components: &[&str]) -> Self {
        let argument = last_key(argument);
        let unit = units::of_name(argument).map_or("", |unit| unit.ending);
        let stem = units::without_unit(argument);
        let short = match stem {
            "force" | "moment" => &stem[..1],
            "inertia" => "i",
            _ => "",
        };
        let spellings = |component: &&str| {
            let mut all = vec![format!("{component}_{unit}"), (*component).to_owned()];
            all.extend([format!("{stem}_{component}_{unit}"), format!("{stem}_{component}")]);
            if !short.is_empty() {
                all.push(format!("{short}{component}"));
            }
            all
        };
        Self(components.iter().map(spellings).collect())
    }

    /// Coordinates x, y, z of an argument that is a vector.
    pub(crate) fn of_vector(argument: &str) -> Self {
        Self::of_components(argument, &["x", "y", "z"])
    }

    /// Roll, pitch, yaw.
    pub(crate) fn of_angles() -> Self {
        let spelled = |angle: &str| vec![format!("{angle}_deg"), angle.to_owned()];
        Self(["roll", "pitch", "yaw"].map(spelled).to_vec())
    }

    /// Quaternion w, x, y, z.
    pub(crate) fn of_quaternion() -> Self {
        Self(["w", "x", "y", "z"].map(|part| vec![format!("quaternion_{part}"), format!("q{part}")]).to_vec())
    }

    /// Cables by their names, or as the tables of this package name their columns: `tension_platform_NAME_n` of a map,
    /// `unstrained_length_1_m` with the number of the cable of `Equilibria`.
    pub(crate) fn of_cables(cables: &[String], argument: &str) -> Self {
        let argument = last_key(argument);
        let (stems, unit) = if argument.ends_with("_m") {
            (["length", "unstrained_length"], "m")
        } else {
            (["tension", "tension_platform"], "n")
        };
        let number = |i: usize| (i + 1).to_string();
        let spelled = |(i, name): (usize, &String)| {
            let mut all = vec![name.clone()];
            // A name that is the number of another cable would have two meanings.
            if !(0..cables.len()).any(|other| other != i && number(other) == *name) {
                all.extend(stems.map(|stem| format!("{stem}_{name}_{unit}")));
            }
            if !cables.iter().enumerate().any(|(other, name)| other != i && number(i) == *name) {
                all.extend(stems.map(|stem| format!("{stem}_{}_{unit}", number(i))));
            }
            all
        };
        Self(cables.iter().enumerate().map(spelled).collect())
    }

    /// Minimum and maximum of an interval.
    pub(crate) fn of_bounds() -> Self {
        Self([["minimum", "min", "from"], ["maximum", "max", "to"]].map(|all| all.map(str::to_owned).to_vec()).to_vec())
    }

    /// First spellings, for messages.
    fn listed(&self) -> String {
        self.0.iter().map(|spelled| spelled[0].as_str()).collect::<Vec<_>>().join(", ")
    }
}

/// Name of an argument without the place of what contains it, as in `experiments[0].force_n`.
fn last_key(argument: &str) -> &str {
    argument.rsplit('.').next().unwrap_or(argument)
}

/// Labels of the last dimension of an object.
struct Labels {
    /// Texts of the labels.
    texts: Vec<String>,
    /// True for whole numbers in ascending order, which say nothing but the place.
    are_places: bool,
    /// True for the columns of a table, false for the elements of a series.
    are_columns: bool,
}

impl Labels {
    /// Labels of a table or series; `None` for any other object.
    fn of(object: &Bound<'_, PyAny>) -> PyResult<Option<(Self, Vec<Py<PyAny>>)>> {
        let kind = object.get_type();
        let (labels, are_columns) = if kind.hasattr("column_names")? {
            (object.getattr("column_names")?, true)
        } else if kind.hasattr("columns")? {
            (object.getattr("columns")?, true)
        } else if kind.hasattr("index")? {
            (object.getattr("index")?, false)
        } else {
            return Ok(None);
        };
        // The `index` of a sequence is a method.
        if labels.is_callable() {
            return Ok(None);
        }

        let labels: Vec<Bound<'_, PyAny>> = labels.try_iter()?.collect::<PyResult<_>>()?;
        let numbers: Option<Vec<i64>> = labels.iter().map(whole).collect();
        let are_places = numbers.is_some_and(|numbers| numbers.windows(2).all(|pair| pair[0] < pair[1]));
        let text = |label: &Bound<'_, PyAny>| Ok(label.str()?.to_string().trim().to_owned());
        let texts = labels.iter().map(text).collect::<PyResult<_>>()?;
        Ok(Some((Self { texts, are_places, are_columns }, labels.into_iter().map(Bound::unbind).collect())))
    }

    /// Places of the named numbers among the labels; `None` for a number without a label.
    ///
    /// # Errors
    /// A label that is there twice, or two labels for one number.
    fn places(&self, names: &Names) -> Result<Vec<Option<usize>>, String> {
        let place = |spelled: &Vec<String>| {
            let mut found = self.texts.iter().enumerate().filter(|(_, text)| spelled.contains(text));
            let Some((first, text)) = found.next() else { return Ok(None) };
            match found.next() {
                Some((_, other)) => Err(format!("has the {} `{text}` and `{other}`: keep one of them", self.what())),
                None => Ok(Some(first)),
            }
        };
        names.0.iter().map(place).collect()
    }

    /// Reason why labels do not name all numbers that are needed.
    fn missing(&self, names: &Names, place: usize) -> String {
        const SHOWN: usize = 8;
        let shown: Vec<String> = self.texts.iter().take(SHOWN).map(|text| short(text)).collect();
        let more = if self.texts.len() > SHOWN { ", …" } else { "" };
        format!(
            "has the {} {}{more}, and none for `{}`: name them {}, or give an array in this order (`.to_numpy()`)",
            self.what(),
            shown.join(", "),
            names.0[place][0],
            names.listed()
        )
    }

    /// Label that looks like one of the names, in another unit, but is none.
    fn near(&self, names: &Names, places: &[Option<usize>]) -> Option<String> {
        let stem = |text: &str| text.split('_').next().unwrap_or_default().to_lowercase();
        let missing = names.0.iter().zip(places).filter(|(_, place)| place.is_none()).map(|(spelled, _)| &spelled[0]);
        let pairs = missing.flat_map(|name| self.texts.iter().map(move |text| (name, text)));
        let (name, text) = pairs.into_iter().find(|(name, text)| stem(name) == stem(text))?;
        let text = short(text);
        Some(format!("has the {} `{text}` and no `{name}`: give it as `{name}`, or leave it out", self.what()))
    }

    fn what(&self) -> &'static str {
        if self.are_columns { "columns" } else { "labels" }
    }
}

/// Whole number of a label.
fn whole(label: &Bound<'_, PyAny>) -> Option<i64> {
    let is_whole = label.is_instance_of::<PyInt>()
        || (!label.is_instance_of::<PyString>() && label.hasattr("__index__").unwrap_or(false));
    if is_whole { label.call_method0("__index__").ok()?.extract().ok() } else { None }
}

/// Numbers with labels, which are read when the names are known under which they are wanted.
pub(crate) struct LabelledNumbers {
    object: Py<PyAny>,
    labels: Labels,
    /// Labels as objects.
    keys: Vec<Py<PyAny>>,
}

impl LabelledNumbers {
    /// Numbers of a table or series; `None` for any other object.
    pub(crate) fn of(object: &Bound<'_, PyAny>) -> PyResult<Option<Self>> {
        if !has_method(object, "__array__")? {
            return Ok(None);
        }
        let labelled = Labels::of(object)?;
        Ok(labelled.map(|(labels, keys)| Self { object: object.clone().unbind(), labels, keys }))
    }

    /// All numbers in their places, without their labels.
    pub(crate) fn array(&self) -> Result<ArrayD<f64>, Unusable> {
        Python::attach(|py| read(self.object.bind(py)))
    }

    /// Numbers by their names, all of which are needed: a row per number. `None` for labels that are places.
    pub(crate) fn by_name(&self, names: &Names) -> Result<Option<Vec<Vec<f64>>>, Unusable> {
        let places = self.labels.places(names).map_err(Unusable::here)?;
        let all: Option<Vec<usize>> = places.iter().copied().collect();
        match (all, places.iter().position(Option::is_none)) {
            (Some(all), _) => all.into_iter().map(|place| self.numbers(place)).collect::<Result<_, _>>().map(Some),
            (None, _) if self.labels.are_places => Ok(None),
            (None, missing) => Err(Unusable::here(self.labels.missing(names, missing.unwrap_or_default()))),
        }
    }

    /// Numbers of poses by their names: position, then angles or a quaternion if they are there. `None` for labels that
    /// are places.
    pub(crate) fn of_pose(&self) -> Result<Option<Vec<Vec<f64>>>, Unusable> {
        let places = |names: &Names| self.labels.places(names).map_err(Unusable::here);
        let Some(mut numbers) = self.by_name(&Names::of_vector("position_m"))? else { return Ok(None) };
        let (angles, quaternion) = (Names::of_angles(), Names::of_quaternion());
        let of_angles = places(&angles)?;
        if let Some(near) = self.labels.near(&angles, &of_angles) {
            return Err(Unusable::here(near));
        }
        let has_angles = of_angles.iter().any(Option::is_some);
        if places(&quaternion)?.iter().any(Option::is_some) {
            if has_angles {
                return Err(Unusable::here("has angles and a quaternion: keep one of them".to_owned()));
            }
            numbers.extend(self.by_name(&quaternion)?.unwrap_or_default());
        } else if has_angles {
            let zeros = vec![0.0; numbers[0].len()];
            for place in of_angles {
                numbers.push(place.map_or_else(|| Ok(zeros.clone()), |place| self.numbers(place))?);
            }
        }
        Ok(Some(numbers))
    }

    /// True for a table, whose rows have the labels; a series is one such row.
    pub(crate) fn is_table(&self) -> bool {
        self.labels.are_columns
    }

    /// Column of a table, or element of a series.
    fn numbers(&self, place: usize) -> Result<Vec<f64>, Unusable> {
        let label = format!("[\"{}\"]", short(&self.labels.texts[place]));
        Python::attach(|py| {
            let object = self.object.bind(py);
            let part = if self.labels.are_columns {
                object.get_item(self.keys[place].bind(py))?
            } else {
                object.try_iter()?.nth(place).transpose()?.unwrap_or_else(|| py.None().into_bound(py))
            };
            Ok(read(&part)?.iter().copied().collect())
        })
        .map_err(|error: Unusable| error.at(&label))
    }
}
