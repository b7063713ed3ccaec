//! A passage of the run beside a finer one: what the run says of it.

use super::Scalar;
use crate::execute::Comparison;
use crate::units::percent;

/// One sentence: how far both passages differ, and what follows.
pub fn compared_passage(compared: &Comparison) -> String {
    let Comparison { axles, difference, limit } = compared;
    let follows = match compared.refines() {
        true => format!(", more than {}: from there on the run took the finer passages", percent(*limit)),
        false => format!(", within {}", percent(*limit)),
    };
    format!(
        "after {axles} axles a passage was computed again with twice the elements and shorter steps: the settlement that \
         a train adds differs by {}{follows}",
        percent(*difference)
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
        let of = |difference| compared_passage(&Comparison { axles: 40, difference, limit: 0.005 });
        assert!(of(0.0003).ends_with("differs by 0.03 %, within 0.5 %"), "{}", of(0.0003));
        assert!(of(0.012).ends_with("1.2 %, more than 0.5 %: from there on the run took the finer passages"));
    }
}
