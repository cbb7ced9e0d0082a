//! Values along one axis of a grid.

/// Values along one axis.
#[derive(Debug, Clone, PartialEq)]
pub enum Steps {
    /// Values in equal steps, both ends included; at least two, ascending.
    Range {
        /// First value.
        from: f64,
        /// Last value.
        to: f64,
        /// Number of values.
        count: usize,
    },
    /// Listed values, at least one.
    List(Vec<f64>),
}

impl Steps {
    /// Range of `count` values from `from` to `to`.
    ///
    /// # Errors
    /// A message: fewer than two values, an end that is not above the start, or more values than there are different
    /// floating-point numbers in the range.
    pub fn range(from: f64, to: f64, count: usize) -> Result<Self, String> {
        if !(to > from && from.is_finite() && to.is_finite()) {
            return Err(format!("the range ends at {to}, it must end above its start {from}"));
        }
        if count < 2 {
            return Err(format!(
                "a range cannot have {count} values: give 2 or more, or a single value without a range"
            ));
        }
        if (to - from) / (count - 1) as f64 <= 4.0 * f64::EPSILON * from.abs().max(to.abs()) {
            return Err(format!(
                "between {from} and {to} there are fewer than {count} different numbers: give fewer values"
            ));
        }
        Ok(Self::Range { from, to, count })
    }

    /// First value that is listed twice, if any.
    pub fn repeated(&self) -> Option<f64> {
        let Self::List(values) = self else { return None };
        let mut values = values.clone();
        values.sort_by(f64::total_cmp);
        values.windows(2).find(|pair| pair[0] >= pair[1]).map(|pair| pair[0])
    }

    /// Number of values.
    pub fn count(&self) -> usize {
        match self {
            Self::Range { count, .. } => *count,
            Self::List(values) => values.len(),
        }
    }

    /// Value `i`. The first and the last value of a range are exact.
    ///
    /// # Example
    /// ```
    /// use funicular_study::sweep::Steps;
    ///
    /// let steps = Steps::range(-4.0, 4.0, 81)?;
    /// assert_eq!((steps.at(0), steps.at(40), steps.at(80)), (-4.0, 0.0, 4.0));
    /// # Ok::<(), String>(())
    /// ```
    pub fn at(&self, i: usize) -> f64 {
        match self {
            Self::Range { to, count, .. } if i + 1 == *count => *to,
            Self::Range { from, to, count } => from + (to - from) * (i as f64 / (count - 1) as f64),
            Self::List(values) => values[i],
        }
    }
}

/// Indices along the axes for an index in a grid whose first axis runs fastest.
pub fn digits(mut index: usize, counts: impl Iterator<Item = usize>) -> impl Iterator<Item = usize> {
    counts.map(move |count| {
        let digit = index % count;
        index /= count;
        digit
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_axis_runs_fastest() {
        let of = |index| digits(index, [2, 3].into_iter()).collect::<Vec<_>>();
        assert_eq!([of(0), of(1), of(2), of(5)], [[0, 0], [1, 0], [0, 1], [1, 2]]);
    }

    #[test]
    fn ranges_that_do_not_ascend_or_cannot_be_told_apart_are_refused() {
        assert!(Steps::range(1.0, 1.0, 2).is_err() && Steps::range(2.0, 1.0, 2).is_err());
        assert!(Steps::range(0.0, 1.0, 1).is_err() && Steps::range(0.0, f64::NAN, 3).is_err());
        assert!(Steps::range(1.0, 1.0 + 1e-14, 1000).is_err());
    }
}
