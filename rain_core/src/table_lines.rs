//! Which line of a file each record of a table is on, and how long a line may be.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::io::{self, Read};

/// How long a line may be that holds a record; a `csv` reader keeps all of one line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct LineLimits {
    /// Bytes.
    pub(crate) bytes: usize,
    /// Fields.
    pub(crate) fields: usize,
}

/// Which limit a line went beyond.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TooLong {
    Bytes,
    Fields,
}

/// What a `csv` reader of unquoted tables reads through, to know lines that it passes over itself: empty ones, those
/// that start with `#`, and the second half of CR LF; and to stop at a line beyond its limits.
#[derive(Debug)]
pub(crate) struct TableLines<R> {
    inner: R,
    seen: RefCell<Seen>,
    limits: LineLimits,
    too_long: Option<TooLong>,
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
    /// Bytes and fields so far of the line at hand, if it holds a record.
    bytes: usize,
    fields: usize,
    /// Bytes of a byte-order mark that have passed; 3 once there can be none.
    mark: usize,
}

impl<R> TableLines<R> {
    pub(crate) fn new(inner: R, limits: LineLimits) -> Self {
        let seen = Seen {
            records: VecDeque::new(),
            line: 1,
            at_start: true,
            in_comment: false,
            after_cr: false,
            bytes: 0,
            fields: 0,
            mark: 0,
        };
        Self {
            inner,
            seen: RefCell::new(seen),
            limits,
            too_long: None,
        }
    }

    /// Why reading stopped, if at a line beyond the limits: that of the next record.
    pub(crate) fn too_long(&self) -> Option<TooLong> {
        self.too_long
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
                (self.bytes, self.fields) = (0, 0);
            }
            _ => {
                if self.at_start {
                    self.at_start = false;
                    self.in_comment = byte == b'#';
                    if !self.in_comment {
                        self.records.push_back(self.line);
                        self.fields = 1;
                    }
                }
                if !self.in_comment {
                    self.bytes += 1;
                    self.fields += usize::from(byte == b',');
                }
            }
        }
    }

    fn too_long(&self, limits: &LineLimits) -> Option<TooLong> {
        if self.fields > limits.fields {
            Some(TooLong::Fields)
        } else {
            (self.bytes > limits.bytes).then_some(TooLong::Bytes)
        }
    }
}

impl<R: Read> Read for TableLines<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let stopped = || io::Error::other("a line is too long");
        if self.too_long.is_some() {
            return Err(stopped());
        }
        let count = self.inner.read(buffer)?;
        let seen = self.seen.get_mut();
        for (index, &byte) in buffer.iter().take(count).enumerate() {
            seen.pass(byte);
            self.too_long = seen.too_long(&self.limits);
            if self.too_long.is_some() {
                // What came before is read first: there may be something wrong in it.
                return if index == 0 { Err(stopped()) } else { Ok(index) };
            }
        }
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: LineLimits = LineLimits { bytes: 12, fields: 3 };

    /// First fields and lines of the records in `text`, read a few bytes at a time; last the line that is too long.
    fn lines(text: &str) -> Vec<(String, u64)> {
        let mut csv = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .flexible(true)
            .quoting(false)
            .has_headers(false)
            .buffer_capacity(5)
            .from_reader(TableLines::new(text.as_bytes(), LIMITS));
        let mut record = csv::StringRecord::new();
        let mut found = Vec::new();
        loop {
            match csv.read_record(&mut record) {
                Ok(true) => found.push((record[0].to_owned(), csv.get_ref().next_record())),
                Ok(false) => return found,
                Err(_) => {
                    let too_long = csv.get_ref().too_long().expect("a table");
                    found.push((format!("{too_long:?}"), csv.get_ref().next_record()));
                    return found;
                }
            }
        }
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

    #[test]
    fn a_line_beyond_the_limits_is_not_read_on() {
        let comment = "#,,,,,,,,,,,,,,,,,,,,,,,,";
        for (start, last) in [("", 2), ("\u{feff}", 2), ("#,,,,,,,,,,,,,,,,\n\n", 4)] {
            for (line, too_long) in [
                (",,,", "Fields"),
                ("1234567890123", "Bytes"),
                ("1,2,3,45678901", "Fields"),
            ] {
                let text = format!("{start}1,2,3\n{line}\n9\n");
                let found = lines(&text);
                assert_eq!(found.last(), Some(&(too_long.to_owned(), last)), "{text:?}");
                assert_eq!(found.len(), 2, "{text:?}");
            }
        }
        for text in ["1,2,3\n,,\r\n", "123456789012\n123,456,7890\n", comment] {
            assert!(lines(text).iter().all(|(field, _)| !field.contains('s')), "{text:?}");
        }
    }
}
