//! Dependencies between files: the paths in every file, resolved to the file that defines what they name.
//!
//! Limits: methods of types from other files are not paths, and macros are not expanded, although names inside a macro
//! call count.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::fs;
use std::path::Path;

use crate::tokens::{group, tokens, without_tests};

/// Segments of a path, or of a module's path within the crate.
type Segments = Vec<String>;

/// Longest chain of re-exports; longer ones are circular.
const MOST_HOPS: usize = 8;

/// A crate's files by their paths below `src`.
pub struct House {
    files: BTreeMap<String, File>,
}

struct File {
    /// Path of the file's module; empty for the crate root.
    module: Segments,
    words: Vec<String>,
    /// By local name.
    imports: BTreeMap<String, Segments>,
    /// Glob imports, `use x::*`, from which names may also come.
    globs: Vec<Segments>,
    /// Paths in the code itself.
    paths: Vec<Segments>,
    /// Names that are only re-exported, in a file that declares modules.
    passed_on: BTreeSet<String>,
    /// Whether the file contains more than modules and imports.
    has_code: bool,
}

impl House {
    pub fn read(source: &Path) -> Self {
        let mut found = Vec::new();
        collect(source, "", &mut found);
        Self::of(found.iter().map(|(path, text)| (path.as_str(), text.as_str())))
    }

    pub fn of<'a>(files: impl IntoIterator<Item = (&'a str, &'a str)>) -> Self {
        Self { files: files.into_iter().map(|(path, text)| (path.into(), File::new(path, text))).collect() }
    }

    /// The layers: first folder or file names below `src`, without the crate root.
    pub fn rooms(&self) -> BTreeSet<&str> {
        self.files.values().filter_map(File::room).collect()
    }

    /// Every dependency of one file on another, without those of the crate root, which re-exports everything.
    pub fn looks(&self) -> BTreeSet<(&str, &str)> {
        let mut looks = BTreeSet::new();
        for (from, file) in &self.files {
            let counts = !file.module.is_empty() && file.has_code;
            for path in file.all_paths().filter(|_| counts) {
                let target = self.resolve(file, &path, 0).filter(|to| *to != from && self.files[*to].has_code);
                looks.extend(target.map(|to| (from.as_str(), to)));
            }
        }
        looks
    }

    /// Dependencies on another layer that `may_look(from, into)` forbids.
    pub fn forbidden(&self, may_look: impl Fn(&str, &str) -> bool) -> Vec<String> {
        let room = |path: &str| self.files[path].room().unwrap_or_default();
        let forbidden = |&(from, to): &(&str, &str)| room(from) != room(to) && !may_look(room(from), room(to));
        self.looks().into_iter().filter(forbidden).map(|(from, to)| format!("{from} -> {to}")).collect()
    }

    /// One circle for each set of files that depend on each other.
    pub fn circles(&self) -> Vec<String> {
        circles(self.looks())
    }

    /// One circle for each set of folders that depend on each other. A folder and one inside it count as one.
    pub fn folder_circles(&self) -> Vec<String> {
        let folder = |path: &'_ str| path.rfind('/').map_or(0, |end| end + 1);
        let between = self.looks().into_iter().map(|(from, to)| (&from[..folder(from)], &to[..folder(to)]));
        circles(between.filter(|(from, to)| !from.starts_with(to) && !to.starts_with(from)).collect())
    }

    /// Files outside the layer `wasm` that name one of these crates, including tests.
    pub fn bound_to(&self, crates: &[&str]) -> Vec<&str> {
        let binds = |file: &File| file.words.iter().any(|word| crates.contains(&word.as_str()));
        let outside = self.files.iter().filter(|(_, file)| file.room() != Some("wasm"));
        outside.filter(|(_, file)| binds(file)).map(|(path, _)| path.as_str()).collect()
    }

    /// The file of the module with this path.
    fn file_of(&self, module: &[String]) -> Option<(&str, &File)> {
        self.files.iter().find(|(_, file)| file.module == module).map(|(path, file)| (path.as_str(), file))
    }

    /// The file that defines what a path in `from` names; `None` for another crate's.
    fn resolve(&self, from: &File, path: &[String], hops: usize) -> Option<&str> {
        let (first, mut rest) = path.split_first()?;
        let mut place = match first.as_str() {
            "crate" => Vec::new(),
            "self" => from.module.clone(),
            "super" => from.module.split_last()?.1.to_vec(),
            name => {
                let child = [&from.module[..], &[name.into()]].concat();
                if self.file_of(&child).is_none() {
                    return self.follow(from, name, rest, hops);
                }
                child
            }
        };
        while rest.first().is_some_and(|word| word == "super") {
            place.pop();
            rest = &rest[1..];
        }
        loop {
            let (file_path, file) = self.file_of(&place)?;
            let Some((name, beyond)) = rest.split_first() else { return Some(file_path) };
            let child = [&place[..], std::slice::from_ref(name)].concat();
            if self.file_of(&child).is_none() {
                return self.follow(file, name, beyond, hops).or(Some(file_path));
            }
            (place, rest) = (child, beyond);
        }
    }

    /// The file that defines a name which `file` has imported.
    fn follow(&self, file: &File, name: &str, rest: &[String], hops: usize) -> Option<&str> {
        let import = file.imports.get(name).filter(|import| hops < MOST_HOPS && import[..] != [name])?;
        self.resolve(file, &[&import[..], rest].concat(), hops + 1)
    }
}

/// One circle for each set of names that depend on each other.
fn circles(looks: BTreeSet<(&str, &str)>) -> Vec<String> {
    let mut next: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for (from, to) in looks {
        next.entry(from).or_default().push(to);
    }
    let mut known = BTreeSet::new();
    let mut circles = Vec::new();
    for &start in next.keys() {
        if let Some(circle) = shortest_circle(start, &next)
            && known.insert(circle.iter().copied().collect::<BTreeSet<_>>())
        {
            circles.push(format!("{} -> {start}", circle.join(" -> ")));
        }
    }
    circles
}

/// The shortest chain of dependencies from a name back to itself.
fn shortest_circle<'a>(start: &'a str, next: &BTreeMap<&'a str, Vec<&'a str>>) -> Option<Vec<&'a str>> {
    let mut ways = VecDeque::from([vec![start]]);
    let mut seen = BTreeSet::new();
    while let Some(way) = ways.pop_front() {
        for &to in way.last().and_then(|last| next.get(last)).into_iter().flatten() {
            if to == start {
                return Some(way);
            }
            if seen.insert(to) {
                ways.push_back([&way[..], &[to]].concat());
            }
        }
    }
    None
}

fn collect(folder: &Path, prefix: &str, found: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(folder).expect("the sources are there") {
        let entry = entry.expect("an entry can be read").path();
        let name = entry.file_name().expect("an entry has a name").to_str().expect("names are ASCII");
        if entry.is_dir() {
            collect(&entry, &format!("{prefix}{name}/"), found);
        } else if name.ends_with(".rs") {
            found.push((format!("{prefix}{name}"), fs::read_to_string(&entry).expect("a source is text")));
        }
    }
}

impl File {
    fn new(path: &str, text: &str) -> Self {
        let mut module: Segments = path.trim_end_matches(".rs").split('/').map(String::from).collect();
        if matches!(module.last().map(String::as_str), Some("mod" | "lib" | "main")) {
            module.pop();
        }
        let words = tokens(text);
        let mut file = Self {
            module,
            imports: BTreeMap::new(),
            globs: Vec::new(),
            paths: Vec::new(),
            passed_on: BTreeSet::new(),
            has_code: false,
            words: Vec::new(),
        };
        file.scan(&without_tests(&words));
        file.words = words;
        file
    }

    fn room(&self) -> Option<&str> {
        self.module.first().map(String::as_str)
    }

    /// Paths in the code, and the imports that they use.
    fn all_paths(&self) -> impl Iterator<Item = Segments> + '_ {
        let used = |name: &String| !self.passed_on.contains(name) || self.paths.iter().any(|path| path[0] == *name);
        let imports = self.imports.iter().filter(move |(name, _)| used(name)).map(|(_, path)| path.clone());
        imports.chain(self.globs.iter().cloned()).chain(self.paths.iter().cloned())
    }

    fn scan(&mut self, words: &[String]) {
        // The positions at which the enclosing inline modules end.
        let mut inline: Vec<usize> = Vec::new();
        let mut is_public = false;
        let mut at = 0;
        while at < words.len() {
            inline.retain(|&end| at < end);
            let after = |step: usize| words.get(at + step).map(String::as_str);
            let starts_path = at == 0 || !matches!(words[at - 1].as_str(), "::" | ".");
            match words[at].as_str() {
                "#" if after(1) == Some("[") => at += 1 + group(&words[at + 1..]),
                "#" if after(1) == Some("!") => at += 2 + group(&words[at + 2..]),
                "pub" => {
                    is_public = true;
                    at += if after(1) == Some("(") { 1 + group(&words[at + 1..]) } else { 1 };
                    continue;
                }
                "mod" if after(2) == Some(";") => at += 3,
                "mod" if after(2) == Some("{") => {
                    inline.push(at + 2 + group(&words[at + 2..]));
                    at += 3;
                }
                "use" if after(1) != Some("<") => {
                    let mut found = Vec::new();
                    at = tree(words, at + 1, &[], &mut found) + 1;
                    for (name, path) in found {
                        self.import(name, outside_of(path, inline.len()), is_public);
                    }
                }
                word if starts_path && word.starts_with(|letter: char| letter.is_alphabetic() || letter == '_') => {
                    self.has_code = true;
                    let mut path = vec![word.to_string()];
                    at += 1;
                    while at + 1 < words.len() && words[at] == "::" && words[at + 1] != "<" && words[at + 1] != "{" {
                        path.push(words[at + 1].clone());
                        at += 2;
                    }
                    self.paths.push(outside_of(path, inline.len()));
                }
                _ => at += 1,
            }
            is_public = false;
        }
        if !self.has_code {
            self.paths.clear();
        }
    }

    fn import(&mut self, name: String, path: Segments, is_public: bool) {
        if name == "*" {
            self.globs.push(path);
            return;
        }
        if is_public {
            self.passed_on.insert(name.clone());
        }
        self.imports.insert(name, path);
    }
}

/// A path as seen from outside this many inline modules of the file.
fn outside_of(path: Segments, inline: usize) -> Segments {
    let climbs = path.iter().take_while(|word| *word == "super").count();
    let rest = path[climbs.min(inline)..].to_vec();
    if climbs > 0 && climbs <= inline { [vec!["self".into()], rest].concat() } else { rest }
}

/// The names and paths of a `use` that begins at `at`; returns its end.
fn tree(words: &[String], mut at: usize, prefix: &[String], found: &mut Vec<(String, Segments)>) -> usize {
    let mut path = prefix.to_vec();
    while at < words.len() {
        match words[at].as_str() {
            "::" => at += 1,
            "{" => {
                at += 1;
                while words[at] != "}" {
                    at = tree(words, at, &path, found);
                    at += usize::from(words[at] == ",");
                }
                return at + 1;
            }
            "*" => {
                found.push(("*".into(), path));
                return at + 1;
            }
            "as" => {
                found.push((words[at + 1].clone(), path));
                return at + 2;
            }
            "," | "}" | ";" => break,
            word => {
                // `use x::{self}` imports x.
                if word != "self" || path.is_empty() {
                    path.push(word.into());
                }
                at += 1;
            }
        }
    }
    found.push((path.last().cloned().unwrap_or_default(), path));
    at
}
