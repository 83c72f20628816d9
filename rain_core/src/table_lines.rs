//! Which line of a file each record of a table is on.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::io::{self, Read};

/// What a `csv` reader of unquoted tables reads through, to know lines that it passes over itself: empty ones, those
/// that start with `#`, and the second half of CR LF.
#[derive(Debug)]
pub(crate) struct TableLines<R> {
    inner: R,
    seen: RefCell<Seen>,
}

#[derive(Debug)]
struct Seen {
    /// Lines with records that have been read here and not yet asked for.
    records: VecDeque<u64>,
    /// Line of the next byte, the first is 1.
    line: u64,
    at_start: bool,
    in_comment: bool,
    after_cr: bool,
    /// Bytes of a byte-order mark that have passed; 3 once there can be none.
    mark: usize,
}

impl<R> TableLines<R> {
    pub(crate) fn new(inner: R) -> Self {
        let seen = Seen {
            records: VecDeque::new(),
            line: 1,
            at_start: true,
            in_comment: false,
            after_cr: false,
            mark: 0,
        };
        Self {
            inner,
            seen: RefCell::new(seen),
        }
    }

    /// Line of the record that has just been read; where there was none, of the end.
    pub(crate) fn next_record(&self) -> u64 {
        let mut seen = self.seen.borrow_mut();
        let end = seen.line;
        seen.records.pop_front().unwrap_or(end)
    }

    pub(crate) fn inner(&self) -> &R {
        &self.inner
    }
}

impl Seen {
    fn pass(&mut self, byte: u8) {
        if self.mark < 3 {
            let expected = [0xEF, 0xBB, 0xBF][self.mark];
            self.mark = if byte == expected { self.mark + 1 } else { 3 };
            if byte == expected {
                return;
            }
        }
        let second_half = byte == b'\n' && self.after_cr;
        self.after_cr = byte == b'\r';
        match byte {
            b'\n' if second_half && !self.in_comment => {}
            // A comment goes on to the line feed.
            b'\r' if self.in_comment => {}
            b'\r' | b'\n' => {
                self.line += 1;
                self.at_start = true;
                self.in_comment = false;
            }
            _ if self.at_start => {
                self.at_start = false;
                self.in_comment = byte == b'#';
                if !self.in_comment {
                    self.records.push_back(self.line);
                }
            }
            _ => {}
        }
    }
}

impl<R: Read> Read for TableLines<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.inner.read(buffer)?;
        let seen = self.seen.get_mut();
        for &byte in buffer.iter().take(count) {
            seen.pass(byte);
        }
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// First fields and lines of the records in `text`, read a few bytes at a time.
    fn lines(text: &str) -> Vec<(String, u64)> {
        let mut csv = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .flexible(true)
            .quoting(false)
            .has_headers(false)
            .buffer_capacity(5)
            .from_reader(TableLines::new(text.as_bytes()));
        let mut record = csv::StringRecord::new();
        let mut found = Vec::new();
        while csv.read_record(&mut record).expect("a table") {
            found.push((record[0].to_owned(), csv.get_ref().next_record()));
        }
        found
    }

    #[test]
    fn every_record_has_the_line_that_an_editor_shows() {
        for end in ["\n", "\r\n"] {
            let text = ["1", "# c", "", "4,x", "  ", "#", "#", "\"8", "", "", "11"].join(end);
            for text in [text.clone(), format!("\u{feff}{text}"), text + end] {
                let found = lines(&text);
                let expected = [("1", 1), ("4", 4), ("", 5), ("\"8", 8), ("11", 11)];
                let expected: Vec<_> = expected.iter().map(|(f, l)| ((*f).to_owned(), *l)).collect();
                assert_eq!(found, expected, "{text:?}");
            }
        }
        assert_eq!(lines("\u{feff}# c\n2"), [("2".to_owned(), 2)]);
        assert_eq!(lines("\n\r\n\r\n4"), [("4".to_owned(), 4)]);
        assert!(lines("").is_empty() && lines("#\n\n").is_empty());
    }
}
