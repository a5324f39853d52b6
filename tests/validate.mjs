// Runs the Khronos validator: node tests/validate.mjs FOLDER_OF_THE_VALIDATOR FILE... prints a line of JSON per file.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { resolve } from "node:path";

const [folder, ...files] = process.argv.slice(2);
const validator = createRequire(resolve(folder) + "/")("gltf-validator");
for (const file of files) {
  const { issues } = await validator.validateBytes(new Uint8Array(readFileSync(file)), { maxIssues: 1000 });
  const messages = issues.messages.filter((m) => m.severity < 2).slice(0, 5);
  console.log(
    JSON.stringify({
      errors: issues.numErrors,
      warnings: issues.numWarnings,
      messages: messages.map((m) => `${m.code} ${m.pointer ?? ""}: ${m.message}`),
    }),
  );
}
