//! Published values that were found wrong.

/// Published value that the equations of its own source contradict.
pub(super) struct WrongReference {
    pub(super) source: &'static str,
    pub(super) quantity: &'static str,
    pub(super) published: &'static str,
    pub(super) right: &'static str,
    pub(super) why: &'static str,
}

/// Values that are not used, or compared only as what they are.
pub(super) const WRONG_REFERENCES: [WrongReference; 6] = [
    WrongReference {
        source: "MoorPy, test of its catenary function, row 8",
        quantity: "tension",
        published: "off by 3.6 %",
        right: "the elastic catenary, 40 digits",
        why: "the row does not solve the equations that the other rows solve to 11 digits",
    },
    WrongReference {
        source: "Code_Aster V5.02.100, SDNL100",
        quantity: "period of a heavy cable element of 1 m that swings by ±90° [s]",
        published: "1.6744",
        right: "1.9333",
        why: "1.6744 s is the period of a mass at half the length; the integration of the element's mass at one point \
              gives it, a uniform bar has 1.9333 s",
    },
    WrongReference {
        source: "Nguyen-Van et al. 2020, SAP2000 models of eight cables, lists of eigenvalues",
        quantity: "frequencies of the inclined cables [Hz]",
        published: "in the .LOG files",
        right: "from the tensions of the .$2k files",
        why: "the listed eigenvalues do not follow from the tensions of the model beside them: they are older than it",
    },
    WrongReference {
        source: "Yuan, Courteille, Deblaise 2014, Fig. 2",
        quantity: "λ², ε",
        published: "of 0.06904 kg/m",
        right: "of 0.067 kg/m",
        why: "the numbers of the figure do not follow from the mass per length of Table II",
    },
    WrongReference {
        source: "WireX 3.0, forward kinematics with pulleys (fncPulley)",
        quantity: "free length over a pulley [m]",
        published: "√(r² + b²)",
        right: "√(b² − r²)",
        why: "a wrong sign under the root; its own test, which compares both ways, fails",
    },
    WrongReference {
        source: "ANSYS Mechanical APDL Verification Manual, VM53, computed column",
        quantity: "second and third frequency of a string [Hz]",
        published: "150.875, 229.06",
        right: "149.414, 224.120",
        why: "the error of 13 elements; the target column is right to its digits",
    },
];
