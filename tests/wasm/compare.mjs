// Plays the golden runs of a WebAssembly module and compares their digests with those of a file:
//     node compare.mjs MODULE.wasm golden.txt
// Prints one line per run and a sum. The status is 1 if a digest differs, a run is missing, or there is none.
import { readFileSync } from "node:fs";

const [moduleFile, goldenFile] = process.argv.slice(2);
const words = (line) => line.trim().split(/\s+/);

const expected = new Map();
for (const line of readFileSync(goldenFile, "utf8").split("\n")) {
    const [name, model, early, late] = words(line);
    if (late !== undefined && !line.startsWith("#")) expected.set(`${name} ${model}`, { early, late });
}

// The world asks nothing of its surroundings, so there is nothing to import.
const { instance } = await WebAssembly.instantiate(readFileSync(moduleFile), {});
const { play, text, memory } = instance.exports;

let passed = 0;
let failed = 0;
const tell = (run, problem, seconds) => {
    if (problem === "") passed += 1;
    else failed += 1;
    console.log(`${problem === "" ? "ok    " : "FAILED"} ${run.padEnd(20)} ${seconds.toFixed(2)} s ${problem}`.trimEnd());
};

for (let place = 0; ; place += 1) {
    const start = performance.now();
    let length;
    try {
        length = play(place);
    } catch (error) {
        // What is left of the module after a panic is not worth asking.
        tell(`run ${place}`, `stopped: ${error.message}`, (performance.now() - start) / 1000);
        break;
    }
    if (length === 0) break;
    const seconds = (performance.now() - start) / 1000;
    const line = new TextDecoder().decode(new Uint8Array(memory.buffer, text(), length));
    const [name, model, early, late] = words(line);
    const run = `${name} ${model}`;
    const golden = expected.get(run);
    expected.delete(run);
    if (golden === undefined) tell(run, "is not in the file", seconds);
    else if (golden.early !== early) tell(run, `early already: ${early} instead of ${golden.early}`, seconds);
    else if (golden.late !== late) tell(run, `late only: ${late} instead of ${golden.late}`, seconds);
    else tell(run, "", seconds);
}
for (const run of expected.keys()) tell(run, "was not played", 0);

console.log(`${passed} passed, ${failed} failed`);
process.exit(failed === 0 && passed > 0 ? 0 : 1);
