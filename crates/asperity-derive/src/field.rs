//! A field of a table: what its attribute and its documentation say.

use proc_macro2::TokenStream;
use quote::quote;
use syn::meta::ParseNestedMeta;
use syn::{Attribute, Error, Expr, ExprLit, Field, Ident, Lit, LitInt, LitStr, Meta, Result, Type};

/// The values that a key accepts.
enum Accepts {
    Choice,
    Flag,
    Count(LitInt),
    Number(LitStr),
    Quantity(Expr),
}

/// A field of a table.
pub(crate) struct Key<'a> {
    pub(crate) name: &'a Ident,
    of: &'a Type,
    is_optional: bool,
    accepts: Accepts,
    range: Option<Expr>,
    form: Option<LitStr>,
    default: Option<Expr>,
    written: Option<LitStr>,
    absent: Option<LitStr>,
    example: Option<LitStr>,
    exists: Option<Expr>,
    meaning: String,
}

impl<'a> Key<'a> {
    pub(crate) fn of(field: &'a Field) -> Result<Self> {
        let name = field.ident.as_ref().ok_or_else(|| Error::new_spanned(field, "a key needs a name"))?;
        let (is_optional, of) = match inner(&field.ty) {
            Some(inner) => (true, inner),
            None => (false, &field.ty),
        };
        let attribute = field.attrs.iter().find(|attribute| attribute.path().is_ident("key"));
        let attribute = attribute.ok_or_else(|| Error::new_spanned(field, "a key needs #[key(…)]"))?;
        let (mut accepts, mut range, mut form, mut default) = (None, None, None, None);
        let (mut written, mut absent, mut example, mut exists) = (None, None, None, None);
        attribute.parse_nested_meta(|meta: ParseNestedMeta<'_>| {
            let word = meta.path.require_ident()?.to_string();
            match word.as_str() {
                "choice" => accepts = Some(Accepts::Choice),
                "flag" => accepts = Some(Accepts::Flag),
                "count" => accepts = Some(Accepts::Count(meta.value()?.parse()?)),
                "number" => accepts = Some(Accepts::Number(meta.value()?.parse()?)),
                "quantity" => accepts = Some(Accepts::Quantity(meta.value()?.parse()?)),
                "range" => range = Some(meta.value()?.parse()?),
                "form" => form = Some(meta.value()?.parse()?),
                "default" => default = Some(meta.value()?.parse()?),
                "written" => written = Some(meta.value()?.parse()?),
                "absent" => absent = Some(meta.value()?.parse()?),
                "example" => example = Some(meta.value()?.parse()?),
                "exists" => exists = Some(meta.value()?.parse()?),
                _ => return Err(meta.error("no such word in #[key]")),
            }
            Ok(())
        })?;
        let accepts =
            accepts.ok_or_else(|| Error::new_spanned(attribute, "#[key] says what the key accepts"))?;
        Ok(Self {
            name,
            of,
            is_optional,
            accepts,
            range,
            form,
            default,
            written,
            absent,
            example,
            exists,
            meaning: meaning(&field.attrs, name)?,
        })
    }

    /// The declaration of the key.
    pub(crate) fn declaration(&self) -> Result<TokenStream> {
        let name = self.name.to_string();
        let (kind, meaning) = (self.kind(), &self.meaning);
        let example = match &self.example {
            Some(example) => quote!(#example),
            None => return Err(Error::new_spanned(self.name, "a key needs an example")),
        };
        let fallback = match (&self.absent, &self.default) {
            (Some(text), _) => quote!(Absent(#text)),
            (None, Some(default)) => {
                let text = match &self.written {
                    Some(text) => text.value(),
                    None => written(default)?,
                };
                quote!(Value(#text))
            }
            (None, None) if self.is_optional => {
                return Err(Error::new_spanned(
                    self.name,
                    "an optional key tells what holds without it: `absent`",
                ));
            }
            (None, None) => quote!(Required),
        };
        let exists = match &self.exists {
            Some(exists) => quote!(#exists),
            None => quote!(::asperity_base::table::Exists::Undeclared),
        };
        Ok(quote! {
            ::asperity_base::table::Key {
                name: #name,
                kind: #kind,
                default: ::asperity_base::table::Fallback::#fallback,
                example: #example,
                text: #meaning,
                exists: #exists,
            }
        })
    }

    /// The value of the field without its key.
    pub(crate) fn default(&self) -> Result<TokenStream> {
        match &self.default {
            Some(default) => Ok(quote!(#default)),
            None if self.is_optional => Ok(quote!(None)),
            None => Err(Error::new_spanned(self.name, "a table with `default` has no required key")),
        }
    }

    /// The statement that reads the field from `source`, for the key of this index.
    pub(crate) fn reader(&self, index: usize) -> TokenStream {
        let (name, of) = (self.name, self.of);
        let key = quote!(&<Self as ::asperity_base::table::Table>::SECTION.keys[#index]);
        let given = match &self.accepts {
            Accepts::Choice => quote! {
                source.word(#key)?.map(|word| <#of as ::asperity_base::choice::Choice>::WORDS[word].1)
            },
            Accepts::Flag => quote!(source.flag(#key)?),
            Accepts::Count(_) => quote!(source.count(#key)?),
            Accepts::Number(_) => quote!(source.real(#key, &(#key).kind)?),
            Accepts::Quantity(dimension) => match &self.form {
                None => quote!(source.real(#key, &(#key).kind)?),
                Some(_) => {
                    let bounds = self.bounds();
                    quote!(source.real(#key, &::asperity_base::table::Kind::Quantity(#dimension, #bounds))?)
                }
            },
        };
        let read = match &self.default {
            _ if self.is_optional => given,
            Some(default) => quote!((#given).unwrap_or(#default)),
            None => quote!((#given).ok_or_else(|| source.missing(#key))?),
        };
        quote!(let #name = #read;)
    }

    /// The kind of the key.
    fn kind(&self) -> TokenStream {
        let of = self.of;
        let kind = match (&self.accepts, &self.form) {
            (Accepts::Choice, _) => quote!(Choice(<#of as ::asperity_base::choice::Choice>::NAMES)),
            (Accepts::Flag, _) => quote!(Flag),
            (Accepts::Count(least), _) => quote!(Count { least: #least, most: u64::MAX }),
            (Accepts::Number(noun), _) => {
                let bounds = self.bounds();
                quote!(Number(#noun, #bounds))
            }
            (Accepts::Quantity(_), Some(form)) => quote!(Other { dimension: None, value: #form }),
            (Accepts::Quantity(dimension), None) => {
                let bounds = self.bounds();
                quote!(Quantity(::asperity_base::units::Dimension::#dimension, #bounds))
            }
        };
        quote!(::asperity_base::table::Kind::#kind)
    }

    fn bounds(&self) -> TokenStream {
        match &self.range {
            Some(range) => quote!(::asperity_base::table::Bounds::#range),
            None => quote!(::asperity_base::table::Bounds::Any),
        }
    }
}

/// The type in an `Option`.
fn inner(of: &Type) -> Option<&Type> {
    let Type::Path(path) = of else { return None };
    let last = path.path.segments.last().filter(|last| last.ident == "Option")?;
    let syn::PathArguments::AngleBracketed(arguments) = &last.arguments else { return None };
    match arguments.args.first()? {
        syn::GenericArgument::Type(inner) => Some(inner),
        _ => None,
    }
}

/// The first paragraph of a documentation, as part of a sentence: without a capital and the full stop.
fn meaning(attributes: &[Attribute], name: &Ident) -> Result<String> {
    let mut words = Vec::new();
    for attribute in attributes.iter().filter(|attribute| attribute.path().is_ident("doc")) {
        let Meta::NameValue(doc) = &attribute.meta else { continue };
        let Expr::Lit(ExprLit { lit: Lit::Str(line), .. }) = &doc.value else { continue };
        let line = line.value();
        if line.trim().is_empty() {
            break;
        }
        words.push(line.trim().to_owned());
    }
    let text = words.join(" ");
    let text = text.strip_suffix('.').unwrap_or(&text);
    let mut characters = text.chars();
    let first = characters
        .next()
        .ok_or_else(|| Error::new_spanned(name, "a key needs its meaning, as documentation"))?;
    // A symbol or an abbreviation keeps its capital.
    let is_word = characters.clone().next().is_some_and(char::is_lowercase);
    match is_word {
        true => Ok(first.to_lowercase().chain(characters).collect()),
        false => Ok(text.to_owned()),
    }
}

/// A default as a case file would write it: a number, true or false, or the word of a choice.
fn written(default: &Expr) -> Result<String> {
    match default {
        Expr::Lit(ExprLit { lit: Lit::Bool(flag), .. }) => Ok(flag.value.to_string()),
        Expr::Lit(ExprLit { lit: Lit::Int(number), .. }) => Ok(number.base10_digits().to_owned()),
        Expr::Lit(ExprLit { lit: Lit::Float(number), .. }) => Ok(number.to_string()),
        Expr::Path(path) => {
            let variant = path.path.segments.last().expect("a path has segments").ident.to_string();
            let mut word = String::new();
            for (index, letter) in variant.char_indices() {
                if letter.is_uppercase() && index > 0 {
                    word.push('-');
                }
                word.extend(letter.to_lowercase());
            }
            Ok(format!("\"{word}\""))
        }
        _ => {
            Err(Error::new_spanned(default, "a default is a number, true or false, or a variant of a choice"))
        }
    }
}
