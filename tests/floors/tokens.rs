//! Rust source as a list of words, which is enough to find paths. Types and expressions are not parsed, and macros are
//! not expanded.

/// Identifiers, numbers, `::` and single characters; comments, strings, characters and lifetimes are skipped.
pub fn tokens(source: &str) -> Vec<String> {
    let letters: Vec<char> = source.chars().collect();
    let (mut tokens, mut at) = (Vec::new(), 0);
    while at < letters.len() {
        let rest = &letters[at..];
        let next = rest.get(1).copied();
        at += match rest[0] {
            '/' if next == Some('/') => length_until(rest, |rest| rest[0] == '\n'),
            '/' if next == Some('*') => block_comment(rest),
            '"' => string(rest),
            'r' if raw_string(rest).is_some() => raw_string(rest).unwrap(),
            '\'' => quote(rest),
            ':' if next == Some(':') => {
                tokens.push("::".into());
                2
            }
            letter if is_of_word(letter) => {
                let length = length_until(rest, |rest| !is_of_word(rest[0]));
                let word: String = rest[..length].iter().collect();
                // The prefixes of byte strings and raw strings.
                let is_prefix = matches!(word.as_str(), "b" | "br" | "c" | "cr")
                    && rest.get(length).is_some_and(|&after| matches!(after, '"' | '#'));
                if is_prefix && word.ends_with('r') {
                    at += length - 1;
                    continue;
                }
                if !is_prefix {
                    tokens.push(word);
                }
                length
            }
            letter => {
                if !letter.is_whitespace() {
                    tokens.push(letter.into());
                }
                1
            }
        };
    }
    tokens
}

fn is_of_word(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_'
}

fn length_until(letters: &[char], end: impl Fn(&[char]) -> bool) -> usize {
    (0..letters.len()).find(|&at| end(&letters[at..])).unwrap_or(letters.len())
}

/// Block comments nest.
fn block_comment(letters: &[char]) -> usize {
    let (mut depth, mut at) = (0, 0);
    while at + 1 < letters.len() {
        match [letters[at], letters[at + 1]] {
            ['/', '*'] => (depth, at) = (depth + 1, at + 2),
            ['*', '/'] => (depth, at) = (depth - 1, at + 2),
            _ => at += 1,
        }
        if depth == 0 {
            return at;
        }
    }
    letters.len()
}

fn string(letters: &[char]) -> usize {
    let mut at = 1;
    while at < letters.len() && letters[at] != '"' {
        at += if letters[at] == '\\' { 2 } else { 1 };
    }
    at + 1
}

/// Length of r"..", r#".."# and so on; `None` for an identifier that begins with an r.
fn raw_string(letters: &[char]) -> Option<usize> {
    let fence = letters[1..].iter().take_while(|&&letter| letter == '#').count();
    let open = 1 + fence;
    (letters.get(open) == Some(&'"')).then_some(())?;
    let closes =
        |rest: &[char]| rest[0] == '"' && rest.len() > fence && rest[1..=fence].iter().all(|&mark| mark == '#');
    Some(open + 1 + length_until(&letters[open + 1..], closes) + 1 + fence)
}

/// A character literal or a lifetime.
fn quote(letters: &[char]) -> usize {
    if letters.get(1) == Some(&'\\') {
        return 3 + length_until(&letters[3..], |rest| rest[0] == '\'') + 1;
    }
    if letters.get(2) == Some(&'\'') { 3 } else { 1 + length_until(&letters[1..], |rest| !is_of_word(rest[0])) }
}

/// The tokens without items that are compiled only for tests.
pub fn without_tests(tokens: &[String]) -> Vec<String> {
    const MARK: [&str; 7] = ["#", "[", "cfg", "(", "test", ")", "]"];
    let (mut kept, mut at) = (Vec::new(), 0);
    while at < tokens.len() {
        if tokens[at..].iter().take(MARK.len()).map(String::as_str).eq(MARK) {
            at += MARK.len();
            while tokens.get(at).is_some_and(|token| token == "#") {
                at += 1 + group(&tokens[at + 1..]);
            }
            at += item(&tokens[at..]);
        } else {
            kept.push(tokens[at].clone());
            at += 1;
        }
    }
    kept
}

/// Length of a group from its opening to its closing bracket.
pub fn group(tokens: &[String]) -> usize {
    let mut depth = 0;
    for (at, token) in tokens.iter().enumerate() {
        match token.as_str() {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return at + 1;
        }
    }
    tokens.len()
}

/// Length of an item, up to its semicolon or closing brace.
fn item(tokens: &[String]) -> usize {
    let mut at = 0;
    while at < tokens.len() {
        match tokens[at].as_str() {
            ";" => return at + 1,
            "{" => return at + group(&tokens[at..]),
            "(" | "[" => at += group(&tokens[at..]),
            _ => at += 1,
        }
    }
    at
}
