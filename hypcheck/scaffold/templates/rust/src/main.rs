//! The door between hypcheck and predicate.rs: questions on standard input, answers on standard output.
//!
//!     @BUILD@
//!
//! docs/protocol.md of hypcheck says what is spoken. Nothing here changes when the predicate does.

mod predicate;

use std::hint::black_box;
use std::io::{self, BufRead, BufReader, BufWriter, Read, Write};
use std::ops::RangeInclusive;
use std::time::Instant;

const COLUMNS: usize = 7;
const MOST: usize = 65536;
const NOT_UNDERSTOOD: &str = "the question is not understood";
const NO_ROW: &str = "a row is not seven decimals";

type Row = [f64; COLUMNS];

/// The next line, None at the end of the input.
fn read_line(input: &mut impl BufRead) -> io::Result<Option<String>> {
    let mut line = Vec::new();
    let length = input.read_until(b'\n', &mut line)?;
    Ok((length > 0).then(|| String::from_utf8_lossy(&line).into_owned()))
}

fn parse_row(line: &str) -> Option<Row> {
    let numbers: Option<Vec<f64>> = line
        .split_ascii_whitespace()
        .map(|word| word.parse().ok())
        .collect();
    numbers?.try_into().ok()
}

fn read_text(input: &mut impl BufRead, n: usize) -> Result<Vec<Row>, String> {
    // All lines first, so that the next question is found.
    let lines: io::Result<Vec<_>> = (0..n).map(|_| read_line(input)).collect();
    let lines = lines.map_err(|error| error.to_string())?;
    let row = |line: Option<String>| {
        line.and_then(|text| parse_row(&text))
            .ok_or_else(|| NO_ROW.into())
    };
    lines.into_iter().map(row).collect()
}

fn read_binary(input: &mut impl Read, n: usize) -> Result<Vec<Row>, String> {
    let mut bytes = vec![0; 8 * COLUMNS * n];
    input
        .read_exact(&mut bytes)
        .map_err(|error| error.to_string())?;
    let row = |bytes: &[u8]| {
        let mut row = [0.0; COLUMNS];
        for (value, eight) in row.iter_mut().zip(bytes.chunks_exact(8)) {
            *value = f64::from_le_bytes(eight.try_into().expect("a chunk is eight bytes"));
        }
        row
    };
    Ok(bytes.chunks_exact(8 * COLUMNS).map(row).collect())
}

fn positions(rows: &[Row]) -> Vec<i8> {
    rows.iter().map(|&row| predicate::predicate(row)).collect()
}

fn classify(sequence: u64, rows: &[Row], text: bool) -> Vec<u8> {
    let mut reply = format!("{sequence} {}\n", rows.len()).into_bytes();
    for position in positions(rows) {
        if text {
            reply.extend(format!("{position}\n").bytes());
        } else {
            reply.push(position as u8);
        }
    }
    reply
}

fn time(sequence: u64, rows: &[Row], repeat: usize) -> Vec<u8> {
    let mut answers = Vec::new();
    let start = Instant::now();
    for _ in 0..repeat {
        answers = black_box(positions(black_box(rows)));
    }
    let nanoseconds = start.elapsed().as_nanos();
    let checksum: i64 = answers.into_iter().map(i64::from).sum();
    format!("{sequence} {nanoseconds} {checksum}\n").into_bytes()
}

/// A whole number in the range.
fn count(word: &str, range: RangeInclusive<usize>) -> Result<usize, String> {
    let number = word.parse().ok().filter(|number| range.contains(number));
    number.ok_or_else(|| NOT_UNDERSTOOD.into())
}

fn answer(line: &str, input: &mut impl BufRead) -> Result<Vec<u8>, String> {
    let words: Vec<&str> = line.split_ascii_whitespace().collect();
    let [verb, sequence, n, rest @ ..] = &words[..] else {
        return Err(NOT_UNDERSTOOD.into());
    };
    let sequence: u64 = sequence.parse().map_err(|_| NOT_UNDERSTOOD)?;
    let n = count(n, 0..=MOST)?;
    match (*verb, rest) {
        ("classify", ["text"]) => Ok(classify(sequence, &read_text(input, n)?, true)),
        ("classify", ["binary"]) => Ok(classify(sequence, &read_binary(input, n)?, false)),
        ("time", [repeat, "binary"]) => {
            let repeat = count(repeat, 1..=999_999_999)?;
            Ok(time(sequence, &read_binary(input, n)?, repeat))
        }
        _ => Err(NOT_UNDERSTOOD.into()),
    }
}

fn main() -> io::Result<()> {
    let mut input = BufReader::with_capacity(1 << 16, io::stdin().lock());
    let mut output = BufWriter::new(io::stdout().lock());
    writeln!(output, "{}", predicate::DESCRIPTION)?;
    output.flush()?;
    while let Some(line) = read_line(&mut input)? {
        match answer(&line, &mut input) {
            Ok(reply) => output.write_all(&reply)?,
            Err(trouble) => writeln!(output, "error {trouble}")?,
        }
        output.flush()?;
    }
    Ok(())
}
