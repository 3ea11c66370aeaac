//! Options of a few words, each written in one place.

/// An option that is one of a few words: in a case file, on a command line, in what is printed and in what is kept.
///
/// ```
/// use asperity::Choice;
/// use asperity::solver::Method;
///
/// assert_eq!(Method::PolonskyKeer.word(), "polonsky-keer");
/// assert_eq!(Method::of_word("active-set"), Some(Method::ActiveSet));
/// ```
pub trait Choice: Copy + PartialEq + 'static {
    /// All choices with their words, in the order in which they are offered.
    const WORDS: &'static [(&'static str, Self)];

    /// The words alone.
    const NAMES: &'static [&'static str];

    /// The word of this choice.
    fn word(self) -> &'static str;

    /// The choice of this word, if it is one.
    fn of_word(word: &str) -> Option<Self> {
        Self::WORDS.iter().find(|(known, _)| *known == word).map(|(_, choice)| *choice)
    }
}

/// Makes an enum of unit variants a [`Choice`] of these words, which are what it serialises to.
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

        impl serde::Serialize for $choice {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
                serializer.serialize_str($crate::choice::Choice::word(*self))
            }
        }
    };
}

pub(crate) use choice;
