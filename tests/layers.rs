//! The top modules of the library form layers: none needs, over others or directly, a module that needs it.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
};

/// A word or a sign of Rust; of literals only that they are there.
#[derive(Clone, Debug, PartialEq)]
enum Token {
    Word(String),
    Sign(char),
    Literal,
}

/// The tokens of a source without its comments.
fn tokens(source: &str) -> Vec<Token> {
    let text: Vec<char> = source.chars().collect();
    let at = |i: usize| text.get(i).copied().unwrap_or('\0');
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let mut found = Vec::new();
    let mut i = 0;
    while i < text.len() {
        let c = text[i];
        if c == '/' && at(i + 1) == '/' {
            while i < text.len() && text[i] != '\n' {
                i += 1;
            }
        } else if c == '/' && at(i + 1) == '*' {
            let mut depth = 0;
            while i < text.len() {
                match (text[i], at(i + 1)) {
                    ('/', '*') => (depth, i) = (depth + 1, i + 2),
                    ('*', '/') => (depth, i) = (depth - 1, i + 2),
                    _ => i += 1,
                }
                if depth == 0 {
                    break;
                }
            }
        } else if is_word(c) {
            let start = i;
            while is_word(at(i)) {
                i += 1;
            }
            let word: String = text[start..i].iter().collect();
            let mut hashes = 0;
            while at(i + hashes) == '#' {
                hashes += 1;
            }
            if matches!(word.as_str(), "r" | "br" | "cr") && at(i + hashes) == '"' {
                i += hashes + 1;
                let is_end = |i: usize| at(i) == '"' && (1..=hashes).all(|n| at(i + n) == '#');
                while i < text.len() && !is_end(i) {
                    i += 1;
                }
                i += hashes + 1;
                found.push(Token::Literal);
            } else {
                found.push(Token::Word(word));
            }
        } else if c == '"' {
            i += 1;
            while i < text.len() && text[i] != '"' {
                i += if text[i] == '\\' { 2 } else { 1 };
            }
            i += 1;
            found.push(Token::Literal);
        } else if c == '\'' {
            // A character ends with a quote, a lifetime does not.
            if at(i + 1) == '\\' {
                i += 3;
                while i < text.len() && text[i] != '\'' {
                    i += 1;
                }
                i += 1;
            } else if at(i + 2) == '\'' {
                i += 3;
            } else {
                i += 1;
            }
            found.push(Token::Literal);
        } else {
            if !c.is_whitespace() {
                found.push(Token::Sign(c));
            }
            i += 1;
        }
    }
    found
}

/// The tokens without the items of tests: what follows `#[cfg(test)]` up to its end.
fn without_tests(tokens: &[Token]) -> Vec<Token> {
    let sign = |c: char| Token::Sign(c);
    let word = |w: &str| Token::Word(w.into());
    let attribute = [
        sign('#'),
        sign('['),
        word("cfg"),
        sign('('),
        word("test"),
        sign(')'),
        sign(']'),
    ];
    let mut kept = Vec::new();
    let mut i = 0;
    while i < tokens.len() {
        if !tokens[i..].starts_with(&attribute) {
            kept.push(tokens[i].clone());
            i += 1;
            continue;
        }
        i += attribute.len();
        let mut depth = 0;
        while i < tokens.len() {
            match tokens[i] {
                Token::Sign('{' | '(' | '[') => depth += 1,
                Token::Sign('}' | ')' | ']') => depth -= 1,
                _ => {}
            }
            let is_end = depth == 0 && matches!(tokens[i], Token::Sign('}' | ';'));
            i += 1;
            if is_end {
                break;
            }
        }
    }
    kept
}

/// The first names behind a path that ends before `i`: one, or all of a tree in braces.
fn first_names(tokens: &[Token], mut i: usize) -> Vec<String> {
    match tokens.get(i) {
        Some(Token::Word(name)) => vec![name.clone()],
        Some(Token::Sign('{')) => {
            let mut names = Vec::new();
            let (mut depth, mut is_first) = (0, true);
            loop {
                match tokens.get(i) {
                    Some(Token::Sign('{')) => depth += 1,
                    Some(Token::Sign('}')) => depth -= 1,
                    Some(Token::Sign(',')) if depth == 1 => is_first = true,
                    Some(Token::Word(name)) if is_first && depth == 1 => {
                        names.push(name.clone());
                        is_first = false;
                    }
                    Some(_) => {}
                    None => break,
                }
                if depth == 0 {
                    break;
                }
                i += 1;
            }
            names
        }
        _ => Vec::new(),
    }
}

/// The names at the root of the crate that a file uses. `depth` is the number of modules from the root to it.
fn root_names(source: &str, depth: usize) -> Vec<String> {
    let tokens = without_tests(&tokens(source));
    let is_path = |i: usize| {
        tokens.get(i) == Some(&Token::Sign(':')) && tokens.get(i + 1) == Some(&Token::Sign(':'))
    };
    let mut names = Vec::new();
    // Of each open brace, whether it is that of a module.
    let mut braces: Vec<bool> = Vec::new();
    let mut i = 0;
    while i < tokens.len() {
        match &tokens[i] {
            Token::Sign('{') => {
                let is_module = i >= 2 && tokens[i - 2] == Token::Word("mod".into());
                braces.push(is_module);
            }
            Token::Sign('}') => {
                braces.pop();
            }
            Token::Word(word) if word == "crate" && is_path(i + 1) => {
                names.extend(first_names(&tokens, i + 3));
            }
            Token::Word(word) if word == "super" => {
                let mut up = 1;
                while is_path(i + 1) && tokens.get(i + 3) == Some(&Token::Word("super".into())) {
                    (up, i) = (up + 1, i + 3);
                }
                let depth = depth + braces.iter().filter(|is_module| **is_module).count();
                if up == depth && is_path(i + 1) {
                    names.extend(first_names(&tokens, i + 3));
                }
            }
            _ => {}
        }
        i += 1;
    }
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

/// What each module uses, and a file in which it does.
type Uses = BTreeMap<String, BTreeMap<String, PathBuf>>;

/// The uses of the top modules under `src`. Names that `lib.rs` exports from a module count as that module.
fn uses(src: &Path) -> Uses {
    let root = without_tests(&tokens(&fs::read_to_string(src.join("lib.rs")).unwrap()));
    let mut homes = BTreeMap::new();
    for i in 0..root.len() {
        if let [
            Token::Word(word),
            Token::Word(module),
            Token::Sign(':'),
            Token::Sign(':'),
            ..,
        ] = &root[i..]
            && word == "use"
        {
            for name in first_names(&root, i + 4) {
                homes.insert(name, module.clone());
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

/// The adapters from scenes to the setups of engines are in one place.
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
