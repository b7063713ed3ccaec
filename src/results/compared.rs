//! A passage of the run beside a finer one: what the run says of it.

use super::Scalar;
use crate::execute::Comparison;
use crate::units::percent;

/// One sentence: how far both passages differ, and what follows.
pub fn compared_passage(compared: &Comparison) -> String {
    let Comparison { axles, difference, limit, at_the_end } = compared;
    let within = if compared.exceeds() { "more than" } else { "within" };
    let follows = match (compared.exceeds(), at_the_end) {
        (false, _) => "",
        (true, false) => ": from there on the run took the finer passages",
        (true, true) => ": write `elements_per_bay = 4` and `time_step = 0.1 ms`",
    };
    format!(
        "after {axles} axles a passage was computed again with twice the elements and shorter steps: the settlement that \
         a train adds differs by {}, {within} {}{follows}",
        percent(*difference),
        percent(*limit)
    )
}

/// `passage_difference`: the settlement that a train adds, by both passages: largest difference / largest value.
pub(super) fn summarise_compared(compared: Option<&Comparison>) -> Option<(String, Scalar)> {
    compared.map(|compared| ("passage_difference".to_owned(), Scalar::new(compared.difference, "1")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sentence_says_what_follows() {
        let of =
            |difference, at_the_end| compared_passage(&Comparison { axles: 40, difference, limit: 0.005, at_the_end });
        assert!(of(0.0003, false).ends_with("differs by 0.03 %, within 0.5 %"), "{}", of(0.0003, false));
        assert!(of(0.012, false).ends_with("1.2 %, more than 0.5 %: from there on the run took the finer passages"));
        assert!(of(0.012, true).ends_with("more than 0.5 %: write `elements_per_bay = 4` and `time_step = 0.1 ms`"));
    }
}
