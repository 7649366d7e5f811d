//! What every adapter in Rust shares: the scene's files, and the protocol of commands (docs/protocol.md).
//!
//! Beside the protocol it understands `distance SEQ N tilted-text`: N lines of one decimal follow, the signed distance as
//! the engine reports it, NaN where it reports none.

use std::io::{self, BufRead, Write};
use std::time::Instant;

pub type Triple = [f64; 3];

/// The scene in a folder: α, γ, b, d; the hyperboloid's mesh; points on the spheroid, for those that take its hull.
pub struct Scene {
    pub sizes: Vec<f64>,
    pub vertices: Vec<Triple>,
    pub triangles: Vec<[u32; 3]>,
    pub body: Vec<Triple>,
}

impl Scene {
    pub fn read(folder: &str) -> Scene {
        let read = |name: &str| std::fs::read_to_string(format!("{folder}/{name}")).expect(name);
        let (vertices, triangles) = off(&read("surface.off"));
        Scene { sizes: numbers(&read("sizes.txt")), vertices, triangles, body: off(&read("body.off")).0 }
    }

    /// Whether the spheroid is a ball: the engine's ball takes its place then.
    pub fn round(&self) -> bool {
        self.sizes[2] == self.sizes[3]
    }
}

fn numbers(text: &str) -> Vec<f64> {
    text.split_whitespace().map(|word| word.parse().expect("a decimal")).collect()
}

fn off(text: &str) -> (Vec<Triple>, Vec<[u32; 3]>) {
    let mut lines = text.lines().skip(1);
    let counts = numbers(lines.next().expect("counts"));
    let vertices = lines.by_ref().take(counts[0] as usize).map(|line| numbers(line).try_into().expect("a vertex"));
    let vertices = vertices.collect();
    let corners = |line: &str| numbers(line).iter().skip(1).map(|&index| index as u32).collect::<Vec<_>>();
    let triangles = lines.take(counts[1] as usize).map(|line| corners(line).try_into().expect("a triangle"));
    (vertices, triangles.collect())
}

/// The spheroid's centre and its rotation, a quaternion x, y, z, w.
pub type Pose = (Triple, [f64; 4]);

/// The pose of a row: the rotation takes the z axis to a line along the row's axis.
fn pose(row: &[f64]) -> Pose {
    let length = (row[7] * row[7] + row[8] * row[8] + row[9] * row[9]).sqrt();
    let sign = if row[9] < 0.0 { -1.0 } else { 1.0 }; // the other end of the same line
    let (x, y, z) = (sign * row[7] / length, sign * row[8] / length, sign * row[9] / length);
    let half = ((1.0 + z) * (1.0 + z) + x * x + y * y).sqrt();
    ([row[4], row[5], row[6]], [-y / half, x / half, 0.0, (1.0 + z) / half])
}

fn poses(input: &mut impl BufRead, count: usize, form: &str) -> io::Result<Vec<Pose>> {
    let mut found = Vec::with_capacity(count);
    for _ in 0..count {
        if form.ends_with("binary") {
            let mut bytes = [0; 80];
            input.read_exact(&mut bytes)?;
            let row = bytes.chunks(8).map(|each| f64::from_le_bytes(each.try_into().expect("8 bytes")));
            found.push(pose(&row.collect::<Vec<_>>()));
        } else {
            let mut line = String::new();
            input.read_line(&mut line)?;
            found.push(pose(&numbers(&line)));
        }
    }
    Ok(found)
}

/// Answers questions until standard input ends.
pub fn serve(
    scene: &Scene, name: &str, version: &str, precision: &str,
    touches: impl Fn(&Pose) -> bool, distance: impl Fn(&Pose) -> f64,
) -> io::Result<()> {
    let (mut input, mut output) = (io::stdin().lock(), io::stdout().lock());
    let sizes = &scene.sizes;
    writeln!(
        output,
        r#"{{"protocol":1,"name":"{name}","version":"{version}","language":"rust","precision":"{precision}","question":"contact","tilt":true,"binary":true,"time":true,"domain":{{"settings":[{{"sizes":{sizes:?},"axis":"free"}}]}}}}"#
    )?;
    output.flush()?;
    let mut line = String::new();
    while input.read_line(&mut line)? > 0 {
        let words: Vec<&str> = line.split_whitespace().collect();
        let (word, number, form) = (words[0], words[1], words[words.len() - 1]);
        let asked = poses(&mut input, words[2].parse().expect("a number"), form)?;
        match word {
            "time" => {
                let (began, mut total) = (Instant::now(), 0);
                for _ in 0..words[3].parse::<u64>().expect("a number") {
                    total = asked.iter().filter(|each| touches(each)).count();
                }
                writeln!(output, "{number} {} {total}", began.elapsed().as_nanos())?;
            }
            "distance" => {
                writeln!(output, "{number} {}", asked.len())?;
                asked.iter().try_for_each(|each| writeln!(output, "{:?}", distance(each)))?;
            }
            _ => {
                writeln!(output, "{number} {}", asked.len())?;
                if form.ends_with("binary") {
                    output.write_all(&asked.iter().map(|each| u8::from(touches(each))).collect::<Vec<_>>())?;
                } else {
                    asked.iter().try_for_each(|each| writeln!(output, "{}", u8::from(touches(each))))?;
                }
            }
        }
        output.flush()?;
        line.clear();
    }
    Ok(())
}
