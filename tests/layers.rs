//! The top modules of the library form layers: none depends, directly or via others, on a module that depends on it.

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
};

/// The tokens of a source without comments.
fn tokens(source: &str) -> Vec<TokenTree> {
    let stream: TokenStream = source.parse().expect("Rust");
    without_tests(stream)
}

/// The tokens without test items: those after `#[cfg(test)]` up to the end of the item.
fn without_tests(stream: TokenStream) -> Vec<TokenTree> {
    let mut kept = Vec::new();
    let mut tokens = stream.into_iter();
    while let Some(token) = tokens.next() {
        let is_test = token.to_string().replace(' ', "") == "[cfg(test)]";
        if !is_test {
            kept.push(token);
            continue;
        }
        // The sign # of the attribute; its item ends with a semicolon or a body.
        kept.pop();
        tokens.find(|token| match token {
            TokenTree::Punct(sign) => sign.as_char() == ';',
            TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
            _ => false,
        });
    }
    kept
}

fn is_word(token: Option<&TokenTree>, word: &str) -> bool {
    matches!(token, Some(TokenTree::Ident(found)) if found == word)
}

/// The tokens after a leading `::`.
fn behind_path(tokens: &[TokenTree]) -> Option<&[TokenTree]> {
    let is_colon = |token: &TokenTree| matches!(token, TokenTree::Punct(p) if p.as_char() == ':');
    match tokens {
        [a, b, rest @ ..] if is_colon(a) && is_colon(b) => Some(rest),
        _ => None,
    }
}

/// The leading names: one, or all those of a tree in braces.
fn first_names(tokens: &[TokenTree]) -> Vec<String> {
    match tokens.first() {
        Some(TokenTree::Ident(name)) => vec![name.to_string()],
        Some(TokenTree::Group(tree)) => {
            let tree: Vec<_> = tree.stream().into_iter().collect();
            let is_comma = |t: &TokenTree| matches!(t, TokenTree::Punct(p) if p.as_char() == ',');
            tree.split(is_comma).flat_map(first_names).collect()
        }
        _ => Vec::new(),
    }
}

/// Adds the names at the root of the crate that `tokens` use; `depth` is the module depth of the tokens.
fn add_root_names(tokens: &[TokenTree], depth: usize, names: &mut Vec<String>) {
    let mut i = 0;
    while i < tokens.len() {
        if let TokenTree::Group(group) = &tokens[i] {
            let is_module = i >= 2 && is_word(tokens.get(i - 2), "mod");
            let inner = without_tests(group.stream());
            add_root_names(&inner, depth + usize::from(is_module), names);
        }
        let mut rest = behind_path(&tokens[i + 1..]);
        let mut is_root = is_word(tokens.get(i), "crate");
        if is_word(tokens.get(i), "super") {
            let mut up = 1;
            while let Some([next, above @ ..]) = rest
                && is_word(Some(next), "super")
            {
                (up, i) = (up + 1, i + 3);
                rest = behind_path(above);
            }
            is_root = up == depth;
        }
        if let Some(rest) = rest
            && is_root
        {
            names.extend(first_names(rest));
        }
        i += 1;
    }
}

/// The names at the root of the crate that a file uses.
fn root_names(source: &str, depth: usize) -> Vec<String> {
    let mut names = Vec::new();
    add_root_names(&tokens(source), depth, &mut names);
    names
}

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// Modules used by each module, each with a file that uses it.
type Uses = BTreeMap<String, BTreeMap<String, PathBuf>>;

/// The uses of the top modules under `src`. Names that `lib.rs` re-exports from a module count as that module.
fn uses(src: &Path) -> Uses {
    let root = tokens(&fs::read_to_string(src.join("lib.rs")).unwrap());
    let mut homes = BTreeMap::new();
    for i in 0..root.len() {
        if let [word, TokenTree::Ident(module), rest @ ..] = &root[i..]
            && is_word(Some(word), "use")
            && let Some(rest) = behind_path(rest)
        {
            for name in first_names(rest) {
                homes.insert(name, module.to_string());
            }
        }
    }
    let mut files = Vec::new();
    sources(src, &mut files);
    files.sort();
    let path_of = |file: &Path| {
        let path = file.strip_prefix(src).unwrap().with_extension("");
        let path: Vec<String> = path
            .iter()
            .map(|part| part.to_str().unwrap().to_owned())
            .collect();
        path
    };
    let modules: BTreeSet<String> = files.iter().map(|file| path_of(file)[0].clone()).collect();
    let mut uses = Uses::new();
    for file in files {
        let path = path_of(&file);
        if path[0] == "lib" {
            continue;
        }
        let depth = path.len() - usize::from(path.last().is_some_and(|last| last == "mod"));
        let of = uses.entry(path[0].clone()).or_default();
        for name in root_names(&fs::read_to_string(&file).unwrap(), depth) {
            let module = homes.get(&name).cloned().unwrap_or(name);
            if module != path[0] && modules.contains(&module) {
                of.entry(module).or_insert_with(|| file.clone());
            }
        }
    }
    uses
}

/// A cycle of modules, if there is one: each uses the next, and the last the first.
fn cycle(uses: &Uses) -> Option<Vec<String>> {
    fn visit(
        module: &str,
        uses: &Uses,
        path: &mut Vec<String>,
        done: &mut BTreeSet<String>,
    ) -> Option<Vec<String>> {
        if let Some(start) = path.iter().position(|above| above == module) {
            return Some(path[start..].to_vec());
        }
        if !done.insert(module.to_owned()) {
            return None;
        }
        path.push(module.to_owned());
        let mut below = uses.get(module).into_iter().flatten();
        let found = below.find_map(|(next, _)| visit(next, uses, path, done));
        path.pop();
        found
    }
    let mut done = BTreeSet::new();
    uses.keys()
        .find_map(|module| visit(module, uses, &mut Vec::new(), &mut done))
}

/// The sources of the library.
fn library() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../src")
}

#[test]
fn top_modules_have_no_cycle() {
    let src = library();
    let uses = uses(&src);
    assert!(uses["simulation"].contains_key("lattice"), "{uses:#?}");
    let cycle = cycle(&uses).map(|cycle| {
        let next = cycle.iter().cycle().skip(1);
        let steps = cycle.iter().zip(next).map(|(module, next)| {
            format!("{module} uses {next} in {}", uses[module][next].display())
        });
        steps.collect::<Vec<_>>().join("\n")
    });
    assert!(cycle.is_none(), "a cycle of modules:\n{}", cycle.unwrap());
}

/// Only one module adapts scenes to the setups of engines.
#[test]
fn scenes_use_engines_in_build_only() {
    let src = library();
    let mut files = Vec::new();
    sources(&src.join("scene"), &mut files);
    let engines = ["lattice", "psm", "rock", "sph", "coupling"];
    for file in files {
        let path = file.strip_prefix(&src).unwrap();
        if path.starts_with("scene/build") {
            continue;
        }
        let depth = path.with_extension("").iter().count() - usize::from(path.ends_with("mod.rs"));
        let names = root_names(&fs::read_to_string(&file).unwrap(), depth);
        let engine = names.iter().find(|name| engines.contains(&name.as_str()));
        assert_eq!(engine, None, "{}", path.display());
    }
}

#[test]
fn paths_are_found_in_code_alone() {
    let source = r###"
        //! [`crate::a::X`]
        use crate::{b::{c, d}, e, self as root};
        use super::{f::g, h};
        /* crate::i /* crate::j */ crate::j */
        fn k<'a>(x: &'a str) -> char { let _ = (r#"crate::l"#, "\"crate::m", '"'); crate::n::o(); '\'' }
        mod p { use super::super::q; use super::r; }
        #[cfg(test)]
        mod tests { use crate::s; fn t() { super::super::u(); } }
        #[cfg(test)]
        use crate::v;
        use super::w::x;
    "###;
    assert_eq!(
        root_names(source, 1),
        ["b", "e", "self", "f", "h", "n", "q", "w"]
    );
}

#[test]
fn a_cycle_is_named() {
    let module = |name: &str, of: &[&str]| {
        let of = of.iter().map(|next| (next.to_string(), PathBuf::new()));
        (name.to_owned(), of.collect())
    };
    let acyclic = Uses::from([module("a", &["b", "c"]), module("b", &["c"])]);
    assert_eq!(cycle(&acyclic), None);
    let cyclic = Uses::from([
        module("a", &["b"]),
        module("b", &["c"]),
        module("c", &["b"]),
    ]);
    assert_eq!(cycle(&cyclic), Some(vec!["b".into(), "c".into()]));
}
