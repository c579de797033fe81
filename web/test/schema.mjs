// docs/results.schema.json: validate(results), and what is wrong in validate.errors.
import {readFileSync} from "node:fs";
import Ajv from "ajv/dist/2020.js";

const schema = JSON.parse(readFileSync(new URL("../../docs/results.schema.json", import.meta.url), "utf8"));
export const validate = new Ajv({allErrors: true, allowUnionTypes: true}).compile(schema);
