//! Fields of an error, for programs that pass errors on, such as bindings to other languages.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use super::{Defect, Error, LoadLimit};
use crate::units::Dimension;

/// The value of a field of an [`Error`].
#[derive(Debug)]
#[non_exhaustive]
pub enum Detail<'a> {
    /// A text.
    Text(Cow<'a, str>),
    /// A file or a directory.
    Path(&'a Path),
    /// A quantity, SI, or a pure number.
    Number(f64),
    /// A count or an index.
    Count(usize),
    /// Several counts or indices.
    Counts(&'a [usize]),
    /// Several names.
    Texts(&'a [String]),
    /// Yes or no.
    Flag(bool),
    /// The dimension of another field; `None` for a pure number.
    Dimension(Option<Dimension>),
    /// The error that led to this one.
    Cause(&'a Error),
    /// The error of the operating system.
    System(&'a std::io::Error),
}

macro_rules! details {
    ($($field:ty, $value:ident => $detail:expr;)*) => { $(
        impl<'a> From<&'a $field> for Detail<'a> {
            fn from($value: &'a $field) -> Self {
                $detail
            }
        }
    )* };
}

details! {
    Cow<'static, str>, text => Self::Text(Cow::Borrowed(text));
    &'static str, text => Self::Text(Cow::Borrowed(text));
    String, text => Self::Text(Cow::Borrowed(text));
    Defect, defect => Self::Text(Cow::Owned(defect.to_string()));
    LoadLimit, limit => Self::Text(Cow::Owned(limit.to_string()));
    PathBuf, path => Self::Path(path);
    f64, number => Self::Number(*number);
    usize, count => Self::Count(*count);
    [usize; 2], counts => Self::Counts(counts);
    [usize; 4], counts => Self::Counts(counts);
    Vec<usize>, counts => Self::Counts(counts);
    Vec<String>, texts => Self::Texts(texts);
    bool, flag => Self::Flag(*flag);
    Option<Dimension>, dimension => Self::Dimension(*dimension);
    Box<Error>, cause => Self::Cause(cause);
    std::io::Error, error => Self::System(error);
}

/// Declares the enum of errors, with the names of its variants and of their fields.
macro_rules! causes {
    (
        $(#[$about:meta])*
        pub enum Error {$(
            $(#[$about_variant:meta])*
            $variant:ident $(($inner:ty))? $({$(
                $(#[$about_field:meta])*
                $field:ident: $type:ty,
            )*})?,
        )*}
    ) => {
        $(#[$about])*
        pub enum Error {$(
            $(#[$about_variant])*
            $variant $(($inner))? $({$(
                $(#[$about_field])*
                $field: $type,
            )*})?,
        )*}

        impl Error {
            /// Names of the variants and of their fields.
            pub const VARIANTS: &'static [(&'static str, &'static [&'static str])] =
                &[$((stringify!($variant), &[$($(stringify!($field)),*)?])),*];

            /// Name of the variant.
            pub fn name(&self) -> &'static str {
                match self {
                    $(Self::$variant { .. } => stringify!($variant),)*
                }
            }

            /// Returns the fields of the variant by name; empty for a variant that holds another type, such
            /// as [`Error::Case`].
            pub fn details(&self) -> Vec<(&'static str, Detail<'_>)> {
                match self {
                    $(Self::$variant { $($($field,)*)? .. } => vec![$($((stringify!($field), $field.into())),*)?],)*
                }
            }
        }
    };
}

pub(super) use causes;
