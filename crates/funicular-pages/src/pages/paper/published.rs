//! Published numbers and results of other programs for comparison, each with its source.

/// Table III of the paper: resonances of the experiment [Hz], ± 0.1 Hz.
pub(crate) const EXPERIMENT: [f64; 12] = [1.2, 1.5, 1.8, 2.0, 2.5, 4.0, 4.7, 5.6, 6.3, 7.7, 8.6, 9.5];
/// Table III: peaks of the response with dynamic stiffness [Hz].
pub(crate) const DYNAMIC: [f64; 10] = [1.1, 1.4, 1.8, 2.0, 4.3, 4.6, 5.4, 6.3, 7.8, 9.4];
/// Table III: the quasi-static sagging model [Hz].
pub(crate) const STATIC_SAG: [f64; 5] = [1.4, 2.1, 4.6, 6.0, 7.7];
/// Table III: the spring model [Hz].
pub(crate) const SPRING: [f64; 4] = [2.8, 5.6, 8.2, 9.5];

/// λ² and ε that the paper prints for the cable of its Fig. 2.
pub(crate) const FIG2_PRINTED: (f64, f64) = (7.57, 0.048);

/// Positions of the ideal pose [m] from |B − (p + R A)| = L0, solved by a general root finder with the numbers of
/// Tables I and II: 4 mm, 8 mm.
pub(crate) const IDEAL_POSITION: [[f64; 3]; 2] = [[0.0089, 0.0098, 0.4521], [3.0047, -0.0048, 0.5049]];

/// Equilibrium computed by MoorPy.
pub(crate) struct MoorPyEquilibrium {
    /// Platform mass [kg].
    pub(crate) mass: f64,
    /// Position [m].
    pub(crate) position: [f64; 3],
}

/// Equilibria from MoorPy 1.3.0 (no water, sea bed 100 m below, EA = E π d²/4, w = m g with g = 9.81, point-mass body
/// with its centre of mass at the platform origin, tolerance 1e-7); printed there to 1e-5 m. 4 mm set, 8 mm set.
pub(crate) const MOORPY: [[MoorPyEquilibrium; 2]; 2] = [
    [
        MoorPyEquilibrium { mass: 10.55, position: [0.0203, 0.01023, 0.45548] },
        MoorPyEquilibrium { mass: 86.35, position: [0.01643, 0.00999, 0.43526] },
    ],
    [
        MoorPyEquilibrium { mass: 10.55, position: [2.92521, -0.00008, 0.56726] },
        MoorPyEquilibrium { mass: 86.35, position: [3.00329, -0.00341, 0.50409] },
    ],
];

/// K11 of the cable of Fig. 2, without damping: frequency [Hz], upper end, lower end [N/m].
///
/// Lumped-mass finite elements of the catenary: MoorPy 1.3.0 line matrices, 200 and 400 segments, Richardson
/// extrapolated. E = 20 GPa, A = 1.2566e-5 m², chord 6.848 m, tension 77.6 N parallel to the chord, 36°, 0.067 kg/m,
/// g = 9.81 m/s²; the other end held; x horizontal in the cable's plane.
pub(crate) const FINITE_ELEMENTS: [[f64; 3]; 18] = [
    [0.0, 15_055.211, 15_054.889],
    [0.5, 14_840.666, 14_805.227],
    [1.0, 14_124.033, 13_971.475],
    [1.5, 12_613.370, 12_214.662],
    [2.0, 9_401.417, 8_481.508],
    [2.4, 3_341.353, 1_442.066],
    [2.8, -18_177.227, -23_542.314],
    [3.0, -81_884.929, -97_495.395],
    [3.3, 92_317.473, 104_705.064],
    [3.6, 47_612.477, 52_805.896],
    [4.0, 35_617.883, 38_871.867],
    [4.5, 30_425.671, 32_834.164],
    [4.9, 27_875.441, 30_020.164],
    [5.5, 26_807.827, 28_487.874],
    [6.0, 25_827.417, 27_266.404],
    [7.0, 24_116.502, 24_493.313],
    [8.0, 25_301.805, 28_111.299],
    [9.5, 23_979.267, 25_787.972],
];
