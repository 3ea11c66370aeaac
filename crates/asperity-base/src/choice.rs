//! Options with a few possible words, each word written in one place.

/// An option with a few possible words. The same words serve case files, the command line, printed output and
/// stored results.
///
/// ```
/// use asperity_base::Choice;
/// use asperity_base::choice::choice;
///
/// #[derive(Debug, Clone, Copy, PartialEq)]
/// enum Fill {
///     Nearest,
///     Harmonic,
/// }
///
/// choice!(Fill: "nearest" => Nearest, "harmonic" => Harmonic);
///
/// assert_eq!(Fill::Nearest.word(), "nearest");
/// assert_eq!(Fill::of_word("harmonic"), Some(Fill::Harmonic));
/// ```
pub trait Choice: Copy + PartialEq + 'static {
    /// All choices with their words, in the order in which they are listed.
    const WORDS: &'static [(&'static str, Self)];

    /// The words alone.
    const NAMES: &'static [&'static str];

    /// The word of this choice.
    fn word(self) -> &'static str;

    /// Returns the choice for this word, if there is one.
    fn of_word(word: &str) -> Option<Self> {
        Self::WORDS.iter().find(|(known, _)| *known == word).map(|(_, choice)| *choice)
    }

    /// Returns a hint for a word that is no choice.
    fn hint(word: &str) -> Option<String> {
        did_you_mean(word, Self::NAMES.iter().copied())
    }
}

/// Returns a hint with the most similar of `words`, if it is similar enough.
pub fn did_you_mean<'w>(word: &str, words: impl Iterator<Item = &'w str>) -> Option<String> {
    let likeness = |candidate: &str| strsim::jaro_winkler(candidate, &word.to_lowercase());
    let nearest = words.max_by(|a, b| likeness(a).total_cmp(&likeness(b)))?;
    (likeness(nearest) > 0.8).then(|| format!("did you mean `{nearest}`?"))
}

/// Returns the hint of [`did_you_mean`] for these words.
pub fn near(words: &[&str]) -> impl Fn(&str) -> Option<String> {
    |word| did_you_mean(word, words.iter().copied())
}

/// Implements [`Choice`] for an enum of unit variants with these words, and serialises to them.
#[macro_export]
macro_rules! choice {
    ($choice:ty: $($word:literal => $variant:ident),+ $(,)?) => {
        impl $crate::choice::Choice for $choice {
            const WORDS: &'static [(&'static str, Self)] = &[$(($word, Self::$variant)),+];
            const NAMES: &'static [&'static str] = &[$($word),+];

            fn word(self) -> &'static str {
                match self {
                    $(Self::$variant => $word),+
                }
            }
        }

        impl $crate::choice::serde::Serialize for $choice {
            fn serialize<S: $crate::choice::serde::Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
                serializer.serialize_str($crate::choice::Choice::word(*self))
            }
        }
    };
}

pub use crate::choice;
#[doc(hidden)]
pub use serde;
