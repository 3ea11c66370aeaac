//! The derive of a part of a table.

use proc_macro2::TokenStream;
use quote::quote;
use syn::meta::ParseNestedMeta;
use syn::parse::ParseStream;
use syn::{Data, DataEnum, DeriveInput, Error, Fields, Ident, LitStr, Path, Result, Token, Variant};

use crate::field::{Field, fields, kebab, snake};

/// Contents of the attribute of a part.
#[derive(Default)]
struct Attribute {
    key: Option<LitStr>,
    example: Option<LitStr>,
    meaning: Option<LitStr>,
    hint: Option<LitStr>,
    absent: Option<LitStr>,
    check: Option<Path>,
}

pub(crate) fn derive(input: &DeriveInput) -> Result<TokenStream> {
    let mut attribute = Attribute::default();
    if let Some(part) = input.attrs.iter().find(|attribute| attribute.path().is_ident("part")) {
        part.parse_nested_meta(|meta| attribute.take(&meta))?;
    }
    match &input.data {
        Data::Enum(data) if attribute.key.is_some() => choice(input, data, &attribute),
        Data::Enum(data)
            if data.variants.iter().all(|variant| matches!(variant.fields, Fields::Named(_))) =>
        {
            kinds(input, data, &attribute)
        }
        Data::Enum(data) => one_of(input, data, &attribute),
        _ => group(input, &attribute),
    }
}

/// A struct: all of its keys.
fn group(input: &DeriveInput, attribute: &Attribute) -> Result<TokenStream> {
    let fields = fields(input)?.named.iter().map(Field::read).collect::<Result<Vec<_>>>()?;
    let declarations = declarations(&fields)?;
    let keys = keys(&fields, &quote!(KEYS));
    let sections = sections(&fields, &quote!(KEYS), &quote!(tables));
    let read = reader(&fields, &quote!(KEYS), attribute.check.as_ref());
    let check = checkers(&fields, &quote!(KEYS), |name| quote!(&self.#name));
    let check = quote!(#check Ok(()));
    Ok(implementation(&input.ident, false, [quote!(#(#declarations),*), keys, sections, read, check]))
}

/// An enum of single values: exactly one of the keys, each named as its variant.
fn one_of(input: &DeriveInput, data: &DataEnum, attribute: &Attribute) -> Result<TokenStream> {
    let hint =
        need(input, attribute.hint.as_ref(), "one of several keys needs a `hint` for none and for two")?;
    let absent = need(input, attribute.absent.as_ref(), "one of several keys needs `absent`")?;
    let fields = data.variants.iter().map(|variant| single(variant, absent)).collect::<Result<Vec<_>>>()?;
    let declarations = declarations(&fields)?;
    let keys = keys(&fields, &quote!(KEYS));
    let names: Vec<String> = fields.iter().map(|field| field.name.to_string()).collect();
    let arms = data.variants.iter().zip(&fields).enumerate().map(|(index, (variant, field))| {
        let (variant, name) = (&variant.ident, field.name.to_string());
        let given = field.value(&quote!(&KEYS[#index]));
        quote!(#name => #given.map(Self::#variant),)
    });
    let read = quote! {
        let given = match __source.exactly_one(&[#(#names),*], #hint)? {
            #(#arms)*
            _ => unreachable!("the source names one of these"),
        };
        Ok(given.expect("this key is given"))
    };
    let checks = data.variants.iter().zip(&fields).enumerate().map(|(index, (variant, field))| {
        let (variant, check) = (&variant.ident, field.checker(&quote!(value), &quote!(&KEYS[#index])));
        quote! {
            #[allow(unused_variables, reason = "a special value has no bounds")]
            Self::#variant(value) => { #check }
        }
    });
    let check = quote!(match self { #(#checks)* } Ok(()));
    let declarations = quote!(#(#declarations),*);
    Ok(implementation(&input.ident, false, [declarations, keys, TokenStream::new(), read, check]))
}

/// Returns the key of a variant with a single value.
fn single<'a>(variant: &'a Variant, absent: &LitStr) -> Result<Field<'a>> {
    match &variant.fields {
        Fields::Unnamed(fields) if fields.unnamed.len() == 1 => {
            let name = Ident::new(&snake(&variant.ident), variant.ident.span());
            Field::named(name, &variant.attrs, &fields.unnamed[0].ty, absent)
        }
        _ => Err(Error::new_spanned(variant, "one of several keys has one value")),
    }
}

/// An enum of several kinds: a key that names one, and the keys that each gives a meaning.
fn choice(input: &DeriveInput, data: &DataEnum, attribute: &Attribute) -> Result<TokenStream> {
    let key = need(input, attribute.key.as_ref(), "a choice needs its `key`")?;
    let example = need(input, attribute.example.as_ref(), "a key needs an `example`")?;
    let meaning = need(input, attribute.meaning.as_ref(), "a key needs its `meaning`")?;
    let words: Vec<String> = data.variants.iter().map(|variant| kebab(&variant.ident)).collect();
    let declaration = quote! {
        ::asperity_base::table::Key {
            name: #key,
            kind: ::asperity_base::table::Kind::Choice(&[#(#words),*]),
            default: ::asperity_base::table::Fallback::Required,
            example: #example,
            text: #meaning,
            exists: ::asperity_base::table::Exists::Undeclared,
            beside: &[],
        }
    };
    let choice_of = |word: &String| format!("{} = \"{word}\"", key.value());
    let (mut sections, mut arms, mut checks) = (TokenStream::new(), TokenStream::new(), TokenStream::new());
    for (index, (variant, word)) in data.variants.iter().zip(&words).enumerate() {
        let (choice, ident) = (choice_of(word), &variant.ident);
        let (keys, read, check) = match &variant.fields {
            Fields::Unit => {
                (quote!(let keys = Vec::new();), quote!(Self::#ident), quote!(Self::#ident => {}))
            }
            Fields::Unnamed(fields) if fields.unnamed.len() == 1 => {
                let part = &fields.unnamed[0].ty;
                (
                    quote!(let keys = <#part as ::asperity_base::table::Part>::keys();),
                    quote!(Self::#ident(<#part as ::asperity_base::table::Part>::read(__source)?)),
                    quote!(Self::#ident(part) => <#part as ::asperity_base::table::Part>::check(part)?,),
                )
            }
            Fields::Named(fields) => {
                let fields = fields.named.iter().map(Field::read).collect::<Result<Vec<_>>>()?;
                named(ident, &fields)?
            }
            Fields::Unnamed(_) => {
                return Err(Error::new_spanned(variant, "a kind is a struct, or has keys of its own"));
            }
        };
        sections.extend(quote! {
            {
                #keys
                sections.push(::asperity_base::table::Section { tables, kind: #choice, keys: keys.leak() });
            }
        });
        checks.extend(check);
        arms.extend(quote! {
            Some(#index) => { __source.suits(#choice)?; #read }
        });
    }
    let check_all = attribute.check.as_ref().map(|check| quote!(#check(&read, __source)?;));
    let read = quote! {
        const WORDS: &[&str] = &[#(#words),*];
        let chosen = ::asperity_base::table::optional(__source, &KEYS[0], |value| {
            value.word(WORDS, &::asperity_base::choice::near(WORDS))
        })?;
        let read = match chosen {
            #arms
            _ => return Err(__source.missing(&KEYS[0])),
        };
        #check_all
        Ok(read)
    };
    let keys = quote!(keys.push(KEYS[0]););
    let check = quote!(match self { #checks } Ok(()));
    Ok(implementation(&input.ident, true, [declaration, keys, sections, read, check]))
}

/// An enum of several kinds, exactly one of which is given by the key of its name, the first of its fields.
fn kinds(input: &DeriveInput, data: &DataEnum, attribute: &Attribute) -> Result<TokenStream> {
    let hint =
        need(input, attribute.hint.as_ref(), "one of several kinds needs a `hint` for none and for two")?;
    let names: Vec<String> = data.variants.iter().map(|variant| snake(&variant.ident)).collect();
    let (mut sections, mut arms, mut checks) = (TokenStream::new(), TokenStream::new(), TokenStream::new());
    for (variant, kind) in data.variants.iter().zip(&names) {
        let fields = variant.fields.iter().map(Field::read).collect::<Result<Vec<_>>>()?;
        let parts: Vec<_> = fields.iter().filter_map(Field::part).collect();
        // A choice among the keys looks itself for those that do not suit it.
        let suits = quote! {
            if !(false #(|| <#parts as ::asperity_base::table::Part>::CHOOSES)*) {
                __source.suits(#kind)?;
            }
        };
        let (keys, read, check) = named(&variant.ident, &fields)?;
        sections.extend(quote! {
            {
                #keys
                sections.push(::asperity_base::table::Section { tables, kind: #kind, keys: keys.leak() });
                #(sections.extend(<#parts as ::asperity_base::table::Part>::sections(tables));)*
            }
        });
        arms.extend(quote!(#kind => { #suits #read }));
        checks.extend(check);
    }
    let check_all = attribute.check.as_ref().map(|check| quote!(#check(&read, __source)?;));
    let read = quote! {
        let read = match __source.exactly_one(&[#(#names),*], #hint)? {
            #arms
            _ => unreachable!("the source names one of these"),
        };
        #check_all
        Ok(read)
    };
    let check = quote!(match self { #checks } Ok(()));
    Ok(implementation(&input.ident, false, [TokenStream::new(), TokenStream::new(), sections, read, check]))
}

/// The statements and expressions of a variant with keys: its `keys`, the reader, and the arm that checks it.
fn named(ident: &Ident, fields: &[Field<'_>]) -> Result<(TokenStream, TokenStream, TokenStream)> {
    let (declarations, list) = (declarations(fields)?, quote!(KEYS));
    let own = quote!(const KEYS: &[::asperity_base::table::Key] = &[#(#declarations),*];);
    let (keys, readers) = (keys(fields, &list), readers(fields, &list));
    let names: Vec<_> = fields.iter().map(|field| &field.name).collect();
    let checks = checkers(fields, &list, |name| quote!(#name));
    Ok((
        quote!(#own let mut keys = Vec::new(); #keys),
        quote!(#own #readers Self::#ident { #(#names),* }),
        quote! {
            #[allow(unused_variables, reason = "words have no bounds")]
            Self::#ident { #(#names),* } => { #own #checks }
        },
    ))
}

/// The implementation of a part, which may be a choice, with the declarations of the own keys, the statements
/// that add keys and sections, and the bodies of its reader and its check.
///
/// The source has a name that no key has, because the keys are variables beside it.
fn implementation(
    part: &Ident,
    chooses: bool,
    [declarations, keys, sections, read, check]: [TokenStream; 5],
) -> TokenStream {
    quote! {
        const _: () = {
            const KEYS: &[::asperity_base::table::Key] = &[#declarations];

            #[allow(clippy::vec_init_then_push, unused_mut, reason = "one statement for each key")]
            impl ::asperity_base::table::Part for #part {
                const CHOOSES: bool = #chooses;

                fn keys() -> Vec<::asperity_base::table::Key> {
                    let mut keys = Vec::new();
                    #keys
                    keys
                }

                #[allow(unused_variables, reason = "a part may have no choice")]
                fn sections(tables: &'static [&'static str]) -> Vec<::asperity_base::table::Section> {
                    let mut sections = Vec::new();
                    #sections
                    sections
                }

                fn read(__source: &dyn ::asperity_base::table::Source) -> ::asperity_base::error::Result<Self> {
                    #read
                }

                fn check(&self) -> ::asperity_base::error::Result<()> {
                    #check
                }
            }
        };
    }
}

/// The declarations of the keys of fields, without those of parts.
pub(crate) fn declarations(fields: &[Field<'_>]) -> Result<Vec<TokenStream>> {
    fields.iter().filter(|field| field.part().is_none()).map(Field::declaration).collect()
}

/// The fields, each with the index of its key in the list of their own keys, in which parts have none.
fn numbered<'f, 'a>(fields: &'f [Field<'a>]) -> impl Iterator<Item = (usize, &'f Field<'a>)> {
    fields.iter().scan(0, |next, field| {
        let index = *next;
        *next += usize::from(field.part().is_none());
        Some((index, field))
    })
}

/// The statements that add the keys of fields to `keys`, from the `list` of their own keys and from their
/// parts.
pub(crate) fn keys(fields: &[Field<'_>], list: &TokenStream) -> TokenStream {
    let each = numbered(fields).filter(|(_, field)| field.with.is_empty());
    let each = each.map(|(index, field)| match field.part() {
        Some(part) => quote!(keys.extend(<#part as ::asperity_base::table::Part>::keys());),
        None => quote!(keys.push(#list[#index]);),
    });
    each.collect()
}

/// The statements that add to `sections` the keys that have a meaning only with a choice, in these `tables`:
/// those of parts, then those of the fields that name it.
pub(crate) fn sections(fields: &[Field<'_>], list: &TokenStream, tables: &TokenStream) -> TokenStream {
    let parts = fields.iter().filter_map(Field::part);
    let parts = parts
        .map(|part| quote!(sections.extend(<#part as ::asperity_base::table::Part>::sections(#tables));));
    let mut kinds: Vec<&String> = Vec::new();
    for kind in fields.iter().flat_map(|field| &field.with) {
        if !kinds.contains(&kind) {
            kinds.push(kind);
        }
    }
    let own = kinds.into_iter().map(|kind| {
        let keys = numbered(fields).filter(|(_, field)| field.with.contains(kind));
        let keys = keys.map(|(index, _)| quote!(#list[#index]));
        quote! {
            sections.push(::asperity_base::table::Section { tables: #tables, kind: #kind, keys: vec![#(#keys),*].leak() });
        }
    });
    parts.chain(own).collect()
}

/// The statements that read each field into a variable of its name.
fn readers(fields: &[Field<'_>], list: &TokenStream) -> TokenStream {
    numbered(fields).map(|(index, field)| field.reader(&quote!(&#list[#index]))).collect()
}

/// The statements that check each field, whose value is an expression of its name.
pub(crate) fn checkers(
    fields: &[Field<'_>],
    list: &TokenStream,
    value: impl Fn(&Ident) -> TokenStream,
) -> TokenStream {
    let each =
        numbered(fields).map(|(index, field)| field.checker(&value(&field.name), &quote!(&#list[#index])));
    each.collect()
}

/// The body of a function that reads a struct with these fields, and checks it.
pub(crate) fn reader(fields: &[Field<'_>], list: &TokenStream, check: Option<&Path>) -> TokenStream {
    let (readers, names) = (readers(fields, list), fields.iter().map(|field| &field.name));
    let check = check.map(|check| quote!(#check(&read, __source)?;));
    quote! {
        #readers
        let read = Self { #(#names),* };
        #check
        Ok(read)
    }
}

/// Reads `check = path`.
pub(crate) fn check(input: ParseStream<'_>) -> Result<Path> {
    let word: Ident = input.parse()?;
    if word != "check" {
        return Err(Error::new_spanned(word, "expected a name, `default`, or `check = …`"));
    }
    input.parse::<Token![=]>()?;
    input.parse()
}

fn need<'a>(input: &DeriveInput, given: Option<&'a LitStr>, message: &str) -> Result<&'a LitStr> {
    given.ok_or_else(|| Error::new_spanned(&input.ident, message))
}

impl Attribute {
    fn take(&mut self, meta: &ParseNestedMeta<'_>) -> Result<()> {
        let word = meta.path.require_ident()?.to_string();
        if word == "check" {
            self.check = Some(meta.value()?.parse()?);
            return Ok(());
        }
        let place = match word.as_str() {
            "key" => &mut self.key,
            "example" => &mut self.example,
            "meaning" => &mut self.meaning,
            "hint" => &mut self.hint,
            "absent" => &mut self.absent,
            _ => return Err(meta.error("no such word in #[part]")),
        };
        *place = Some(meta.value()?.parse()?);
        Ok(())
    }
}
