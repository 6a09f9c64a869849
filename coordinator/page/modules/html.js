// Elements and their state: preact with htm, as vendored; templates are in the language of the page.

import { html as template } from "../vendor/preact.js";
import { inLanguage } from "./language/language.js";

export {
  render,
  useCallback,
  useEffect,
  useErrorBoundary,
  useLayoutEffect,
  useMemo,
  useRef,
  useState,
} from "../vendor/preact.js";

export const html = inLanguage(template);
