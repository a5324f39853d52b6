//! Numbers with their nouns, for sentences.

/// `1 page`, `2 pages`. The noun is given for one, and takes an `s`.
pub fn counted(n: u64, noun: &str) -> String {
    let plural = if n == 1 { "" } else { "s" };
    format!("{n} {noun}{plural}")
}

/// One of two words: the first for one, the second for none or several.
pub fn either(n: u64, one: &'static str, several: &'static str) -> &'static str {
    if n == 1 { one } else { several }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_is_singular_and_none_is_plural() {
        assert_eq!([0, 1, 2].map(|n| counted(n, "page")), ["0 pages", "1 page", "2 pages"]);
        assert_eq!([0, 1, 2].map(|n| either(n, "is", "are")), ["are", "is", "are"]);
    }
}
