//! Drawing of a calibration in figures and pages: anchors with their covariance, and the rows as linear equations, with
//! which a page fits again without some of them.

use super::Calibrated;
use super::report::CalibrationReport;
use crate::rows::rows;
use funicular::calibration::CalibrationUnknown;
use funicular::math::DMat;
use serde_json::{Value, json};

/// Largest half axis of an ellipse of two deviations, as a part of the width of the room; smaller ones are drawn
/// larger.
const LARGEST: f64 = 0.08;

rows! {
    /// Anchor after a calibration.
    pub struct AnchorRow {
        pub cable: String;
        /// Point of the robot file.
        pub start_m: [f64; 3];
        pub position_m: [f64; 3];
        /// Places of its coordinates among the values; none for a coordinate that is known.
        pub places: [Option<usize>; 3] = hidden;
        /// Covariance of the coordinates with inner conditions; zero along a known coordinate, absent without
        /// deviations.
        pub covariance_m2: Option<[[f64; 3]; 3]>;
        /// One deviation along the weakest combination.
        pub weakest_m: Option<[f64; 3]>;
    }
}

rows! {
    /// Rows as linear equations about the fit, for fits without some of them (96j).
    pub struct LinearRows {
        /// Changes of the values along the free directions, one list per value.
        pub free: Vec<Vec<f64>>;
        /// Covariance with inner conditions.
        pub inner: Vec<Vec<f64>>;
        /// Information of all rows and priors.
        pub information: Vec<Vec<f64>>;
        /// Net rows of each row, with their residuals.
        pub rows: Vec<NetRows>;
        /// Factors that turn changes of the values into their units.
        pub units: Vec<f64>;
        pub chi2: f64;
        pub degrees_of_freedom: usize;
        /// Factor of the deviations if it does not come from the residuals.
        pub factor: Option<f64>;
    }
}

rows! {
    /// Equations that one row leaves for the values.
    pub struct NetRows {
        pub by_free: Vec<Vec<f64>>;
        pub residuals: Vec<f64>;
    }
}

impl Calibrated {
    /// Factor with which ellipses are drawn: 1, 2, 5 times a power of ten, not below 1.
    pub fn magnification(&self) -> f64 {
        let span = |axis: usize| {
            let ends = self.anchors.iter().map(|row| row.position_m[axis]);
            let (low, high) = ends.fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)));
            high - low
        };
        let width = self.axes.iter().map(|axis| span(*axis)).fold(0.0, f64::max);
        let of_tool = self.accuracy.iter().flat_map(|accuracy| accuracy.poses.iter().map(|row| row.covariance_m2));
        let variances = self.anchors.iter().filter_map(|row| row.covariance_m2).chain(of_tool);
        let largest = variances.flat_map(|of| [of[0][0], of[1][1], of[2][2]]).fold(0.0, f64::max);
        let wanted = LARGEST * width / (2.0 * largest.sqrt());
        if !wanted.is_finite() || wanted <= 1.0 {
            return 1.0;
        }
        let power = 10.0_f64.powf(wanted.log10().floor());
        let step = [5.0, 2.0, 1.0].into_iter().find(|step| step * power <= wanted).unwrap_or(1.0);
        step * power
    }

    /// Data with which the script of a page fits again without some rows: the linear equations, the numbers of their
    /// rows, the values and anchors that they move, and the factor with which ellipses are drawn. `linear` is null
    /// where a combination is lost.
    pub fn refit_data(&self) -> Value {
        let values = self
            .values
            .iter()
            .map(|row| json!({ "path": row.path, "unit": row.unit, "value": row.value, "held": row.held }));
        let anchors = self.anchors.iter().map(|row| json!({ "position": row.position_m, "places": row.places }));
        json!({
            "linear": self.linear,
            "rows": self.rows.iter().map(|row| row.row).collect::<Vec<_>>(),
            "values": values.collect::<Vec<_>>(),
            "anchors": anchors.collect::<Vec<_>>(),
            "magnification": self.magnification(),
        })
    }
}

fn lists(matrix: &DMat) -> Vec<Vec<f64>> {
    matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
}

impl CalibrationReport<'_> {
    /// Anchors of a report; `weakest` is the weakest combination with its deviation.
    pub(super) fn anchors(&self, weakest: Option<(&[f64], f64)>) -> Vec<AnchorRow> {
        let robot = self.of.robot_at(&self.found.best.values).robot;
        let inner = self.frame.inner(&self.precision.covariance);
        let scale = self.factor.filter(|_| self.precision.lost.is_empty()).map(|factor| factor * factor);
        let row = |(i, cable): (usize, &funicular::robot::Cable)| {
            let places = [0, 1, 2].map(|axis| self.of.position_of(&CalibrationUnknown::Anchor { cable: i, axis }));
            let entry = |a: Option<usize>, b: Option<usize>| a.zip(b).map_or(0.0, |(a, b)| inner[(a, b)]);
            AnchorRow {
                cable: cable.name.clone(),
                start_m: self.of.robot.cables[i].anchor.point_w.into(),
                position_m: cable.anchor.point_w.into(),
                places,
                covariance_m2: scale.map(|scale| places.map(|a| places.map(|b| scale * entry(a, b)))),
                weakest_m: weakest
                    .map(|(direction, deviation)| places.map(|place| place.map_or(0.0, |k| deviation * direction[k]))),
            }
        };
        robot.cables.iter().enumerate().map(row).collect()
    }

    /// Rows of a report as linear equations; `None` where a combination is lost.
    pub(super) fn linear_rows(&self) -> Option<LinearRows> {
        if !self.precision.lost.is_empty() {
            return None;
        }
        let free = self.frame.free_directions();
        let rows = self.precision.net_rows();
        let values = &self.found.best.values;
        Some(LinearRows {
            free: lists(free),
            inner: lists(&(self.frame.inner_projection() * free)),
            information: lists(&self.precision.information),
            rows: rows.map(|(net, residuals)| NetRows { by_free: lists(net), residuals: residuals.to_vec() }).collect(),
            units: values.iter().enumerate().map(|(k, value)| self.of.meaning(k, *value)[1]).collect(),
            chi2: self.found.best.chi2,
            degrees_of_freedom: self.precision.degrees,
            factor: self.request.length_std_m.and(self.factor),
        })
    }
}
