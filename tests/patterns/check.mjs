// Regular expressions in JavaScript's way of writing -> what recheck says of each. JSON in, JSON out.
//
// In: [[source, flags], …]. Out: [{status, complexity, degree, pumps: [[prefix, pump], …], suffix}, …].
import { readFileSync } from "node:fs";
import { checkSync } from "recheck";

// Bounds count steps and no time: where another process takes the cores, a slow run would count as an attack.
const BOUNDS = {
  timeout: null,
  incubationTimeout: null,
  seedingTimeout: null,
  attackTimeout: null,
  attackLimit: 50_000_000,
};

const answers = JSON.parse(readFileSync(0, "utf8")).map(([source, flags]) => {
  const said = checkSync(source, flags, BOUNDS);
  return {
    status: said.status,
    complexity: said.complexity?.type ?? said.error?.kind,
    degree: said.complexity?.degree ?? 0,
    pumps: said.attack?.pumps.map(({ prefix, pump }) => [prefix, pump]) ?? [],
    suffix: said.attack?.suffix ?? "",
  };
});
process.stdout.write(JSON.stringify(answers));
