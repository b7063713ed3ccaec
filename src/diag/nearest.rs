//! The known word that a misspelt word most likely means: the same word in another case, its plural, singular or
//! abbreviation, or else a word with few different letters.

/// The candidate nearest to `word`, if one is near enough; of equally near candidates the first in alphabetical order.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let lower = word.to_lowercase();
    candidates
        .into_iter()
        .filter(|candidate| *candidate != word)
        .filter_map(|candidate| Some((rank(&lower, &candidate.to_lowercase())?, candidate)))
        .min()
        .map(|(_, candidate)| candidate)
}

/// Distance of a candidate, both in lower case: 0 for the same word, 1 for a plural, 2 for an abbreviation, else 2 plus
/// the slips.
fn rank(word: &str, candidate: &str) -> Option<usize> {
    if word == candidate {
        return Some(0);
    }
    if is_plural(word, candidate) || is_plural(candidate, word) {
        return Some(1);
    }
    let length = word.chars().count();
    if length >= 3 && candidate.starts_with(word) {
        return Some(2);
    }
    // One slip in a short word, one more for each four letters.
    let bound = match length {
        0 | 1 => 0,
        2..=4 => 1,
        _ => (length / 4 + 1).min(4),
    };
    // If the lengths differ too much, no table is needed.
    if length.abs_diff(candidate.chars().count()) > bound {
        return None;
    }
    let slips = strsim::damerau_levenshtein(word, candidate);
    (slips <= bound && slips < length).then_some(2 + slips)
}

fn is_plural(many: &str, one: &str) -> bool {
    many.strip_prefix(one).is_some_and(|ending| matches!(ending, "s" | "es"))
        || many.strip_suffix("ies").is_some_and(|stem| one.strip_suffix('y') == Some(stem))
}

#[cfg(test)]
mod tests {
    use super::*;

    const FIELDS: [&str; 8] =
        ["stiffness", "damping", "damping_time", "density", "sleeper", "sleepers", "youngs_modulus", "spacing"];

    #[test]
    fn slips_of_the_hand_are_found() {
        for (slip, meant) in [
            ("stifness", "stiffness"),
            ("stiffnes", "stiffness"),
            ("dampnig", "damping"),
            ("desnity", "density"),
            ("young_modulus", "youngs_modulus"),
            ("spacings", "spacing"),
        ] {
            assert_eq!(nearest(slip, FIELDS), Some(meant), "{slip}");
        }
    }

    #[test]
    fn case_comes_before_plural_before_prefix_before_slips() {
        assert_eq!(nearest("Sleeper", FIELDS), Some("sleeper"));
        assert_eq!(nearest("dens", FIELDS), Some("density"));
        assert_eq!(nearest("pads", ["pad", "pass"]), Some("pad"));
        assert_eq!(nearest("axle", ["apple", "axles"]), Some("axles"));
        assert_eq!(nearest("bodies", ["bodices", "body"]), Some("body"));
        assert_eq!(nearest("stiff", FIELDS), Some("stiffness"));
    }

    #[test]
    fn far_words_and_the_word_itself_are_not_offered() {
        assert_eq!(nearest("banana", FIELDS), None);
        assert_eq!(nearest("x", ["y", "z"]), None);
        assert_eq!(nearest("density", ["density"]), None);
        assert_eq!(nearest("", FIELDS), None);
        assert_eq!(nearest("kN", ["kn"]), Some("kn"));
    }

    #[test]
    fn the_order_of_the_candidates_does_not_matter() {
        assert_eq!(nearest("bat", ["cat", "hat", "rat"]), Some("cat"));
        assert_eq!(nearest("bat", ["rat", "hat", "cat"]), Some("cat"));
    }
}
