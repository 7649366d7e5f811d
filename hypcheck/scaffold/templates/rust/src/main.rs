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

const MOST: usize = 65536;
const NOT_UNDERSTOOD: &str = "the question is not understood";

@position@
/// What the predicate claims of its rows: how many numbers they have, and what stands before their form.
@passage@
/// What the predicate claims: how many numbers its rows have, and whether it gives times.
@end@
#[derive(Clone, Copy)]
struct Rows {
    columns: usize,
@position@
    tilted: &'static str,
@passage@
    times: bool,
@end@
    none: &'static str,
}
@position@

const UPRIGHT: Rows = Rows {
    columns: 7,
    tilted: "",
    none: "a row is not seven decimals",
};
const TILTED: Rows = Rows {
    columns: 10,
    tilted: "tilted-",
    none: "a row is not ten decimals",
};
@end@

/// The next line, None at the end of the input.
fn read_line(input: &mut impl BufRead) -> io::Result<Option<String>> {
    let mut line = Vec::new();
    let length = input.read_until(b'\n', &mut line)?;
    Ok((length > 0).then(|| String::from_utf8_lossy(&line).into_owned()))
}

fn parse_row(line: &str, columns: usize) -> Option<Vec<f64>> {
    let numbers: Option<Vec<f64>> = line
        .split_ascii_whitespace()
        .map(|word| word.parse().ok())
        .collect();
    numbers.filter(|numbers| numbers.len() == columns)
}

fn read_text(input: &mut impl BufRead, n: usize, form: Rows) -> Result<Vec<f64>, String> {
    // All lines first, so that the next question is found.
    let lines: io::Result<Vec<_>> = (0..n).map(|_| read_line(input)).collect();
    let lines = lines.map_err(|error| error.to_string())?;
    let row = |line: Option<String>| {
        line.and_then(|text| parse_row(&text, form.columns))
            .ok_or_else(|| form.none.to_string())
    };
    let rows: Result<Vec<_>, String> = lines.into_iter().map(row).collect();
    Ok(rows?.concat())
}

fn read_binary(input: &mut impl Read, n: usize, form: Rows) -> Result<Vec<f64>, String> {
    let mut bytes = vec![0; 8 * form.columns * n];
    input
        .read_exact(&mut bytes)
        .map_err(|error| error.to_string())?;
    let number =
        |eight: &[u8]| f64::from_le_bytes(eight.try_into().expect("a chunk is eight bytes"));
    Ok(bytes.chunks_exact(8).map(number).collect())
}

@position@
fn positions(rows: &[f64], form: Rows) -> Vec<i8> {
    let rows = rows.chunks_exact(form.columns);
    if form.columns == 7 {
        rows.map(|row| predicate::predicate(row.try_into().expect("a row is seven numbers")))
@passage@
/// The times of first contact, negative where there is none.
fn passages(rows: &[f64], form: Rows) -> Vec<f64> {
    let rows = rows.chunks_exact(form.columns);
    if form.columns == 10 {
        rows.map(|row| predicate::predicate(row.try_into().expect("a row is ten numbers")))
@end@
            .collect()
    } else {
@position@
        rows.map(|row| predicate::tilted(row.try_into().expect("a row is ten numbers")))
@passage@
        rows.map(|row| predicate::tilted(row.try_into().expect("a row is thirteen numbers")))
@end@
            .collect()
    }
}

@passage@
fn hit(first: f64) -> u8 {
    u8::from(first >= 0.0)
}

@end@
fn classify(sequence: u64, rows: &[f64], form: Rows, text: bool) -> Vec<u8> {
    let mut reply = format!("{sequence} {}\n", rows.len() / form.columns).into_bytes();
@position@
    for position in positions(rows, form) {
        if text {
            reply.extend(format!("{position}\n").bytes());
        } else {
            reply.push(position as u8);
        }
@passage@
    let times = passages(rows, form);
    for &first in &times {
        if !text {
            reply.push(hit(first));
        } else if form.times && hit(first) == 1 {
            reply.extend(format!("1 {first:?}\n").bytes());
        } else {
            reply.extend(format!("{}\n", hit(first)).bytes());
        }
    }
    if form.times && !text {
        reply.extend(times.iter().flat_map(|first| first.to_le_bytes()));
@end@
    }
    reply
}

fn time(sequence: u64, rows: &[f64], form: Rows, repeat: usize) -> Vec<u8> {
@position@
    let mut answers = Vec::new();
@passage@
    let mut times = Vec::new();
@end@
    let start = Instant::now();
    for _ in 0..repeat {
@position@
        answers = black_box(positions(black_box(rows), form));
@passage@
        times = black_box(passages(black_box(rows), form));
@end@
    }
    let nanoseconds = start.elapsed().as_nanos();
@position@
    let checksum: i64 = answers.into_iter().map(i64::from).sum();
@passage@
    let checksum: i64 = times.into_iter().map(|first| i64::from(hit(first))).sum();
@end@
    format!("{sequence} {nanoseconds} {checksum}\n").into_bytes()
}

/// A whole number in the range.
fn count(word: &str, range: RangeInclusive<usize>) -> Result<usize, String> {
    let number = word.parse().ok().filter(|number| range.contains(number));
    number.ok_or_else(|| NOT_UNDERSTOOD.into())
}

fn answer(line: &str, input: &mut impl BufRead, form: Rows) -> Result<Vec<u8>, String> {
    let words: Vec<&str> = line.split_ascii_whitespace().collect();
    let [verb, sequence, n, rest @ ..] = &words[..] else {
        return Err(NOT_UNDERSTOOD.into());
    };
    let sequence: u64 = sequence.parse().map_err(|_| NOT_UNDERSTOOD)?;
    let n = count(n, 0..=MOST)?;
@position@
    let how = rest.last().and_then(|how| how.strip_prefix(form.tilted));
@passage@
    let how = rest.last().and_then(|how| how.strip_prefix("passage-"));
@end@
    match (*verb, rest, how) {
        ("classify", [_], Some("text")) => {
            Ok(classify(sequence, &read_text(input, n, form)?, form, true))
        }
        ("classify", [_], Some("binary")) => Ok(classify(
            sequence,
            &read_binary(input, n, form)?,
            form,
            false,
        )),
        ("time", [repeat, _], Some("binary")) => {
            let repeat = count(repeat, 1..=999_999_999)?;
            Ok(time(sequence, &read_binary(input, n, form)?, form, repeat))
        }
        _ => Err(NOT_UNDERSTOOD.into()),
    }
}

fn main() -> io::Result<()> {
    let mut input = BufReader::with_capacity(1 << 16, io::stdin().lock());
    let mut output = BufWriter::new(io::stdout().lock());
    let tilt = predicate::DESCRIPTION.contains(r#""tilt":true"#);
@position@
    let form = if tilt { TILTED } else { UPRIGHT };
@passage@
    let form = Rows {
        columns: if tilt { 13 } else { 10 },
        times: predicate::DESCRIPTION.contains(r#""times":true"#),
        none: if tilt {
            "a row is not thirteen decimals"
        } else {
            "a row is not ten decimals"
        },
    };
@end@
    writeln!(output, "{}", predicate::DESCRIPTION)?;
    output.flush()?;
    while let Some(line) = read_line(&mut input)? {
        match answer(&line, &mut input, form) {
            Ok(reply) => output.write_all(&reply)?,
            Err(trouble) => writeln!(output, "error {trouble}")?,
        }
        output.flush()?;
    }
    Ok(())
}
