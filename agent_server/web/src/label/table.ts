/** Labels as the table that `agent-server annotate` reads, which the server gives and takes. */

/** Somebody does something from `onsetS` to `offsetS`, in seconds on the recording's time line. */
export interface Label {
  readonly gesture: string;
  readonly onsetS: number;
  readonly offsetS: number;
  readonly subject: string;
  /** The reaction that ought to follow, or null. */
  readonly expected: string | null;
  /** Whether no reaction at all may happen. */
  readonly quiet: boolean;
}

const COLUMNS = ["gesture", "onset_s", "offset_s", "subject", "expected", "quiet"] as const;

export function formatTable(labels: readonly Label[]): string {
  const rows = labels.map(({ gesture, onsetS, offsetS, subject, expected, quiet }) => [
    gesture,
    `${onsetS}`,
    `${offsetS}`,
    subject,
    expected ?? "",
    quiet ? "yes" : "no",
  ]);
  return [COLUMNS, ...rows].map((row) => `${row.map(quoted).join(",")}\n`).join("");
}

/** The labels of a table as the server writes it. */
export function parseTable(text: string): Label[] {
  const [heading, ...rows] = rowsOf(text);
  if (heading?.join() !== COLUMNS.join()) {
    throw new Error(`the labels cannot be read: expected the columns ${COLUMNS.join()}`);
  }
  return rows.map(([gesture = "", onset = "", offset = "", subject = "", expected = "", quiet]) => ({
    gesture,
    onsetS: Number(onset),
    offsetS: Number(offset),
    subject,
    expected: expected === "" ? null : expected,
    quiet: quiet === "yes",
  }));
}

function quoted(cell: string): string {
  return /[",\r\n]/.test(cell) ? `"${cell.replaceAll('"', '""')}"` : cell;
}

/** A cell, quoted or bare, and what ends it. */
const CELL = /(?:"((?:[^"]|"")*)"|([^",\r\n]*))(,|\r?\n|$)/y;

function rowsOf(text: string): string[][] {
  const rows: string[][] = [];
  let row: string[] = [];
  CELL.lastIndex = 0;
  while (CELL.lastIndex < text.length) {
    const found = CELL.exec(text);
    if (found === null) throw new Error("the labels cannot be read: a quotation mark is missing");
    row.push(found[1]?.replaceAll('""', '"') ?? found[2] ?? "");
    if (found[3] === ",") continue;
    rows.push(row);
    row = [];
  }
  return rows;
}
