// Runs the Khronos validator: node tests/validate.mjs FOLDER_OF_THE_VALIDATOR FILE... prints a line of JSON per file.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";

const [folder, ...files] = process.argv.slice(2);
const validator = createRequire(resolve(folder) + "/")("gltf-validator");
for (const file of files) {
  const read = (path) => new Uint8Array(readFileSync(path));
  const externalResourceFunction = async (uri) => read(join(dirname(file), decodeURIComponent(uri)));
  const { issues } = await validator.validateBytes(read(file), { maxIssues: 0, externalResourceFunction });
  const errors = issues.messages.filter((m) => m.severity == 0);
  const messages = issues.messages.filter((m) => m.severity < 2).slice(0, 5);
  console.log(
    JSON.stringify({
      errors: issues.numErrors,
      warnings: issues.numWarnings,
      errorCodes: [...new Set(errors.map((m) => m.code))],
      messages: messages.map((m) => `${m.code} ${m.pointer ?? ""}: ${m.message}`),
    }),
  );
}
