// Elements and their state: preact with htm, as vendored.

export { html, render, useCallback, useEffect, useErrorBoundary, useMemo, useRef, useState } from "../vendor/preact.js";
