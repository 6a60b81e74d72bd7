// Regular expressions in JavaScript's way of writing -> what recheck says of each. JSON in, JSON out.
//
// In: [[source, flags], …]. Out: [{status, complexity, degree, pumps: [[prefix, pump], …], suffix}, …].
import { readFileSync } from "node:fs";
import { checkSync } from "recheck";

const answers = JSON.parse(readFileSync(0, "utf8")).map(([source, flags]) => {
  const said = checkSync(source, flags, { timeout: 60000 });
  return {
    status: said.status,
    complexity: said.complexity?.type ?? said.error?.kind,
    degree: said.complexity?.degree ?? 0,
    pumps: said.attack?.pumps.map(({ prefix, pump }) => [prefix, pump]) ?? [],
    suffix: said.attack?.suffix ?? "",
  };
});
process.stdout.write(JSON.stringify(answers));
