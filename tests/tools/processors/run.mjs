// node run.mjs PROGRAM < jobs > answers: program.c as WebAssembly, whose memory is written and read here.
import fs from "node:fs";

const { instance } = await WebAssembly.instantiate(fs.readFileSync(process.argv[2]), {});
const program = instance.exports;
const jobs = fs.readFileSync(0);
const answers = [];
let at = 0;
while (at < jobs.length) {
    const memory = new Uint8Array(program.memory.buffer);
    memory.set(jobs.subarray(at, at + 16), program.job_at());
    at += 16;
    const size = 8 * program.width();
    memory.set(jobs.subarray(at, at + size), program.numbers_at());
    at += size;
    const said = program.work();
    if (said < 0) process.exit(3);
    const bytes = Math.floor(said / 2 ** 24), doubles = said % 2 ** 24;
    answers.push(Buffer.from(memory.slice(program.answers_at(), program.answers_at() + bytes)));
    answers.push(Buffer.from(memory.slice(program.times_at(), program.times_at() + 8 * doubles)));
}
fs.writeSync(1, "");
for (const part of answers) for (let done = 0; done < part.length; ) done += fs.writeSync(1, part, done);
