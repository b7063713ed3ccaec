//! The catalogue of diagnostics: a code is never reused, and each has a page in `explain/`.

use super::Severity;

macro_rules! codes {
    ($($code:ident $severity:ident $title:literal)*) => {
        /// The name of a mistake. `E` codes are mistakes of the text, the scene or the run, `L` codes physics rules.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Code { $(#[doc = $title] $code),* }

        impl Code {
            /// Every code, in order.
            pub const ALL: &'static [Code] = &[$(Code::$code),*];

            pub fn as_str(self) -> &'static str {
                match self { $(Code::$code => stringify!($code)),* }
            }

            /// The mistake in a few words.
            pub fn title(self) -> &'static str {
                match self { $(Code::$code => $title),* }
            }

            /// The default severity of the code.
            pub fn severity(self) -> Severity {
                match self { $(Code::$code => Severity::$severity),* }
            }

            /// The page that `trackbed explain` prints.
            pub fn page(self) -> &'static str {
                match self { $(Code::$code => include_str!(concat!("../../explain/", stringify!($code), ".md"))),* }
            }
        }
    };
}

codes! {
    E0101 Error "text that cannot be read here"
    E0102 Error "file that is not readable text"
    E0103 Error "beyond the bounds of the language"
    E0104 Error "bracket without its partner"
    E0105 Error "spelling of another language"
    E0106 Error "text without its closing quote"
    E0201 Error "unknown name"
    E0202 Error "name declared twice"
    E0203 Error "names that depend on each other"
    E0204 Error "module not found"
    E0205 Error "base of another kind"
    E0206 Error "modules that use each other"
    E0207 Error "word that cannot be a name"
    E0301 Error "number without its unit"
    E0302 Error "wrong dimension"
    E0303 Error "unknown unit"
    E0304 Error "basis missing or wrong"
    E0305 Error "operands that do not fit together"
    E0401 Error "unknown kind"
    E0402 Error "unknown field"
    E0403 Error "missing field"
    E0404 Error "field given twice"
    E0405 Error "value out of range"
    E0406 Error "value of another form"
    E0407 Error "values that contradict each other"
    E0408 Error "unknown word"
    E0409 Error "declarations that exclude each other"
    E0410 Warning "hole to be filled before a run"
    E0411 Error "not in this version"
    E0412 Warning "declaration that nothing uses"
    E0414 Error "grading that is no curve"
    E0415 Error "cut that leaves no grading"
    E0416 Warning "grading with a small modelled share"
    E0420 Error "bed narrower than its sleepers"
    E0421 Error "rest of an unknown depth"
    E0422 Note "response that the tier does not give"
    E0419 Error "grains without a modulus under a sleeper"
    E0417 Error "stretch without an effect"
    E0427 Error "tamping without an effect"
    E0428 Error "profiles that do not combine"
    E0418 Error "stretch that the track under it cannot have"
    E0423 Error "rest of a depth that cannot be computed"
    E0424 Error "layers of another depth than those under them"
    E0425 Error "approach slab away from its structure"
    E0426 Error "approach slab outside its layers"
    E0429 Warning "field that does nothing"
    E0501 Error "place off the track"
    E0502 Error "section that does not fit its sleepers"
    E0503 Error "train longer than its track"
    E0504 Error "transitions that do not match the sections"
    E0505 Error "span that does not ascend"
    E0506 Error "profile with a gap"
    E0507 Error "profile whose places do not follow each other"
    E0508 Error "data file that cannot be read"
    E0509 Error "data file with other columns"
    E0510 Error "row of a data file that cannot be used"
    E0511 Error "layer too thin for its grains"
    E0512 Error "stretches that set the same thing"
    E0514 Error "seats on the wrong side of their transition"
    E0601 Error "scene without something to run"
    E0602 Error "axle counts that do not divide"
    E0603 Error "step too coarse to be stable"
    E0604 Warning "scene that only grains can run"
    E0605 Error "random values beyond their range"
    E0606 Error "surface that cannot be read"
    E0607 Error "surface that is no closed body"
    E0610 Error "bed that cannot be packed"
    E0611 Error "rig that cannot be run"
    E0612 Error "plan that does not fit together"
    E0616 Error "expectation that the run cannot answer"
    E0617 Error "load on a sleeper that does not move"
    E0618 Error "trains without weight"
    E0619 Error "states that a rig does not write"
    E0701 Error "study of a scene without trains"
    E0702 Error "axle count between two exchanges"
    E0703 Error "wheel force that grows without limit"
    E0704 Error "variation of an unknown field"
    E0705 Error "illegal point of a study"
    E0706 Error "sampling that does not fit its values"
    E0707 Error "value varied twice"
    E0708 Error "study without a point"
    E0709 Error "study above its budget"
    E0711 Error "study without a feasible design"
    E0712 Warning "study without the scene as it is"
    E0801 Error "no equilibrium found"
    E0802 Error "output folder that cannot be used"
    E0803 Error "checkpoint of another scene"
    E0804 Error "expectation not met"
    E0805 Error "measured curve that cannot be used"
    E0806 Error "law that cannot be fitted"
    E0807 Warning "exchange that overshoots"
    E0808 Error "points of a study that failed"
    E0809 Error "folder of another study"
    E0810 Error "bed that does not come to rest"
    E0811 Error "rig that does not come to rest"
    E0812 Error "rig whose bed gives way"
    E0813 Error "run larger than the memory"
    E0814 Error "track that has sunk"
    E0815 Error "work that a cluster does not do"
    E0816 Error "run that outgrows its memory"
    E0817 Error "law beyond its range"
    L1001 Warning "stiffness jump without mitigation"
    L1002 Warning "speed near the critical speed"
    L1003 Warning "track too short for its train"
    L1004 Warning "settlement law outside its calibration"
    L1005 Warning "time step coarse for the contact"
    L1006 Warning "update interval that overshoots"
    L1007 Warning "sleeper passing near a vehicle resonance"
    L1008 Warning "sleepers below the threshold of their law"
    L1009 Warning "layer of few grains"
    L1010 Warning "unchecked value of the library"
    L1011 Warning "irregularity too sharp for a wheel"
    L1012 Warning "sleeper passing near the resonance of a wheel on the track"
    L1013 Warning "wheel that loses its load over the level of the rail"
    L1014 Warning "rail foot stressed beyond the usual limit"
    L1015 Warning "sleeper pressure beyond the usual limit"
    L1016 Warning "support stiffness outside the measured range"
    L1017 Warning "car body with an unusual bounce frequency"
    L1018 Warning "bed of few grains between its walls"
    L1019 Warning "sleeper on few grains"
    L1020 Warning "step of grains that needs much additional inertia"
    L1021 Warning "grains that overlap too much under their load"
    L1022 Warning "run above its budget"
    L1023 Warning "damper above critical damping"
    L1024 Warning "volume of few grains"
    L1025 Warning "histories with too few or too many samples"
    L1026 Warning "waves of the level too short for steps or elements"
    L1027 Warning "wagon faster than real wagons"
    L1028 Warning "ballast thicker than on real tracks"
    L1029 Warning "ballast below finer layers"
    L1030 Warning "void that no wheel closes"
    L1031 Warning "level of the rail beyond its alert limit"
    L1032 Warning "stretch that softens towards the stiffer side"
    L1033 Warning "declared softer side that is stiffer"
    L1034 Warning "ballast on a structure under a law of force"
    L1035 Warning "speed near the speed of surface waves"
    L1036 Warning "expected error above the tolerance"
    L1037 Warning "designs compared on one packing"
}

impl Code {
    /// The code for a typed text, in upper or lower case.
    pub fn parse(text: &str) -> Option<Code> {
        Code::ALL.iter().copied().find(|c| c.as_str().eq_ignore_ascii_case(text))
    }

    /// The snake_case name by which a scenario allows or denies a physics rule.
    pub fn rule(self) -> Option<&'static str> {
        Some(match self {
            Code::L1001 => "stiffness_jump",
            Code::L1002 => "critical_speed",
            Code::L1003 => "track_too_short",
            Code::L1004 => "law_outside_calibration",
            Code::L1005 => "coarse_time_step",
            Code::L1006 => "update_overshoot",
            Code::L1007 => "passing_frequency",
            Code::L1008 => "below_threshold",
            Code::L1009 => "thin_layer",
            Code::L1010 => "unchecked_values",
            Code::L1011 => "irregularity_too_sharp",
            Code::L1012 => "wheel_on_track",
            Code::L1013 => "wheel_unloading",
            Code::L1014 => "rail_stress",
            Code::L1015 => "ballast_pressure",
            Code::L1016 => "support_stiffness",
            Code::L1017 => "car_body_frequency",
            Code::L1018 => "narrow_bed",
            Code::L1019 => "few_grains_under_sleeper",
            Code::L1020 => "grain_step",
            Code::L1021 => "grain_overlap",
            Code::L1022 => "over_budget",
            Code::L1023 => "overdamped",
            Code::L1024 => "small_volume",
            Code::L1025 => "coarse_record",
            Code::L1026 => "wavelength",
            Code::L1027 => "wagon_speed",
            Code::L1028 => "ballast_thickness",
            Code::L1029 => "layer_order",
            Code::L1030 => "wide_void",
            Code::L1031 => "track_level",
            Code::L1032 => "reversed_wedge",
            Code::L1033 => "transition_sides",
            Code::L1034 => "ballast_on_structure",
            Code::L1035 => "surface_waves",
            Code::L1036 => "outside_tolerance",
            Code::L1037 => "one_packing",
            _ => return None,
        })
    }

    /// Whether a physics rule is silent until a scenario names it in `warn` or `deny`.
    pub fn is_silent(self) -> bool {
        self == Code::L1010
    }

    /// The physics rule of that name.
    pub fn of_rule(name: &str) -> Option<Code> {
        Code::ALL.iter().copied().find(|c| c.rule() == Some(name))
    }
}

impl std::fmt::Display for Code {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.as_str())
    }
}
