// Writes the openapi.json of a service where the types of the page's questions are made from it.

import { mkdirSync, writeFileSync } from "node:fs";
import { Service } from "./service.js";

const service = await Service.start();
mkdirSync("coordinator/page/types", { recursive: true });
writeFileSync("coordinator/page/types/openapi.json", JSON.stringify(await service.json("/openapi.json")));
await service.stop();
