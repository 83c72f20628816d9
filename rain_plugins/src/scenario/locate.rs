//! Finds where in RON text the value of a field path stands, so that a value out of range is reported with its line and
//! column as a syntax error is. The text has been parsed before: this walks it, it does not check it.

/// Line and column (both from 1) of the value that `path` (`vehicles[0].path[2].time_s`) names in `text`, or of the
/// innermost enclosing value that is written there.
#[must_use]
pub fn locate(text: &str, path: &str) -> (usize, usize) {
    let mut at = Walker {
        text: text.as_bytes(),
        offset: 0,
    };
    at.skip_space();
    while at.rest().starts_with(b"#") {
        // `#![enable(…)]` in front of the value.
        at.offset += 1;
        at.skip_value();
        at.skip_space();
    }
    let mut found = at.offset;
    for step in steps(path) {
        if !at.enter(&step) {
            break;
        }
        found = at.offset;
    }
    let before = String::from_utf8_lossy(&text.as_bytes()[..found]);
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
    (line, column)
}

enum Step<'a> {
    Field(&'a str),
    Index(usize),
}

fn steps(path: &str) -> Vec<Step<'_>> {
    path.split(['.', '[', ']'])
        .filter(|s| !s.is_empty())
        .map(|s| s.parse().map_or(Step::Field(s), Step::Index))
        .collect()
}

struct Walker<'a> {
    text: &'a [u8],
    offset: usize,
}

impl Walker<'_> {
    fn rest(&self) -> &[u8] {
        &self.text[self.offset.min(self.text.len())..]
    }

    fn skip_space(&mut self) {
        loop {
            let rest = self.rest();
            let skip = if rest.starts_with(b"//") {
                rest.iter().position(|&c| c == b'\n').unwrap_or(rest.len())
            } else if rest.starts_with(b"/*") {
                block_comment(rest)
            } else {
                rest.iter().take_while(|c| c.is_ascii_whitespace()).count()
            };
            if skip == 0 {
                return;
            }
            self.offset += skip;
        }
    }

    fn word(&self) -> usize {
        self.rest()
            .iter()
            .take_while(|c| c.is_ascii_alphanumeric() || **c == b'_')
            .count()
    }

    /// Past one token; whether it was a bracket, and which way.
    fn skip_token(&mut self) -> Option<Bracket> {
        let rest = self.rest();
        let (length, bracket) = match rest.first() {
            None => (0, None),
            Some(b'"') => (string(rest), None),
            Some(b'r') if raw_string(rest) > 0 => (raw_string(rest), None),
            // A character literal; its content may be a quote or bracket.
            Some(b'\'') => (if rest.get(1) == Some(&b'\\') { 4 } else { 3 }, None),
            Some(b'(' | b'[' | b'{') => (1, Some(Bracket::Open)),
            Some(b')' | b']' | b'}') => (1, Some(Bracket::Close)),
            Some(_) => (self.word().max(1), None),
        };
        self.offset = (self.offset + length).min(self.text.len());
        bracket
    }

    /// Past the value here, up to the comma or bracket that ends it.
    fn skip_value(&mut self) {
        let mut depth = 0_usize;
        loop {
            self.skip_space();
            match self.rest().first() {
                None => return,
                Some(b',' | b')' | b']' | b'}') if depth == 0 => return,
                Some(_) => match self.skip_token() {
                    Some(Bracket::Open) => depth += 1,
                    Some(Bracket::Close) => depth -= 1,
                    None => {}
                },
            }
            // `#![enable(…)]` ends with its bracket, not with a comma.
            if depth == 0 && self.text[..self.offset].ends_with(b"]") {
                return;
            }
        }
    }

    /// To the value of a field or element of the value here; the names of structs and variants before the bracket are
    /// passed over, and so is the bracket of a variant that holds a list.
    fn enter(&mut self, step: &Step) -> bool {
        let start = self.offset;
        if self.try_enter(step) {
            return true;
        }
        self.offset = start;
        false
    }

    fn try_enter(&mut self, step: &Step) -> bool {
        self.skip_space();
        let name = self.word();
        self.offset += name;
        self.skip_space();
        let Some(&open) = self.rest().first() else { return false };
        if !matches!(open, b'(' | b'[' | b'{') {
            return false;
        }
        self.offset += 1;
        self.skip_space();
        if let Step::Index(_) = step
            && name > 0
            && open == b'('
        {
            // `Times([1, 2])`: the list is inside.
            return self.enter(step);
        }
        let mut index = 0;
        loop {
            self.skip_space();
            match self.rest().first() {
                None | Some(b')' | b']' | b'}') => return false,
                Some(_) => {}
            }
            match step {
                Step::Index(wanted) if *wanted == index => return true,
                Step::Field(wanted) => {
                    let word = self.word();
                    let here = &self.rest()[..word] == wanted.as_bytes();
                    let (word_at, _) = (self.offset, self.offset += word);
                    self.skip_space();
                    if self.rest().first() == Some(&b':') {
                        self.offset += 1;
                        self.skip_space();
                        if here {
                            return true;
                        }
                    } else {
                        self.offset = word_at;
                        // A single unnamed value: `Some((…))`, `Variant((…))`.
                        if index == 0 && name > 0 {
                            return self.enter(step);
                        }
                    }
                }
                Step::Index(_) => {}
            }
            self.skip_value();
            self.skip_space();
            if self.rest().first() == Some(&b',') {
                self.offset += 1;
            }
            index += 1;
        }
    }
}

enum Bracket {
    Open,
    Close,
}

/// Length of the block comment at the start; they nest.
fn block_comment(text: &[u8]) -> usize {
    let (mut i, mut depth) = (0, 0_usize);
    while i < text.len() {
        if text[i..].starts_with(b"/*") {
            depth += 1;
            i += 2;
        } else if text[i..].starts_with(b"*/") {
            depth -= 1;
            i += 2;
            if depth == 0 {
                return i;
            }
        } else {
            i += 1;
        }
    }
    i
}

/// Length of the quoted string at the start.
fn string(text: &[u8]) -> usize {
    let mut i = 1;
    while i < text.len() && text[i] != b'"' {
        i += if text[i] == b'\\' { 2 } else { 1 };
    }
    (i + 1).min(text.len())
}

/// Length of the raw string (`r"…"`, `r#"…"#`) at the start, 0 if there is none.
fn raw_string(text: &[u8]) -> usize {
    let hashes = text[1..].iter().take_while(|c| **c == b'#').count();
    if text.get(1 + hashes) != Some(&b'"') {
        return 0;
    }
    let mut end = vec![b'"'];
    end.resize(1 + hashes, b'#');
    let body = 2 + hashes;
    text[body..]
        .windows(end.len())
        .position(|w| w == end)
        .map_or(text.len(), |p| body + p + end.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r#"#![enable(implicit_some)]
// name: "not here"
Scenario(
    name: "a ) \" [",   /* time_s: 5, /* nested */ */
    vehicles: [
        (name: "one", path: [(time_s: 1, position: (0, 0, 0))]),
        (
            name: "two",
            path: [
                (time_s: 1), (time_s: 2),
                (position: (1, 2, 3), time_s: 3),
            ],
        ),
    ],
    captures: Times([1, 2,
        30]),
    sky: Overcast(tint: (1, 2, 3), cloud: 4),
    maybe: Some((a: 1, b: 2)),
)"#;

    #[test]
    fn finds_the_value() {
        for (path, line, column) in [
            ("", 3, 1),
            ("name", 4, 11),
            ("vehicles[0].path[0].time_s", 6, 39),
            ("vehicles[1].path[2].time_s", 11, 47),
            ("vehicles[1].path[2].position[1]", 11, 32),
            ("captures[2]", 16, 9),
            ("sky.cloud", 17, 43),
            ("sky.tint[2]", 17, 32),
            ("maybe.b", 18, 27),
            // Not written: the innermost value that is.
            ("vehicles[0].scale", 6, 9),
            ("vehicles[7].scale", 5, 15),
            ("rain.contrast", 3, 1),
        ] {
            assert_eq!(locate(TEXT, path), (line, column), "{path}");
        }
    }

    #[test]
    fn any_text_ends_the_walk() {
        // Cut anywhere, the walker still ends inside the text.
        for end in (0..TEXT.len()).filter(|i| TEXT.is_char_boundary(*i)) {
            let (line, column) = locate(&TEXT[..end], "vehicles[1].path[2].time_s");
            assert!(line >= 1 && column >= 1);
        }
    }
}
