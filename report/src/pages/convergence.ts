// How a search came to its answer.
import { lineChart } from "../charts";
import { parseCsv, type ReportData } from "../data";
import { h, section } from "../dom";
import { seconds, withUnit, words } from "../format";
import { unitOf } from "./parts";

const roundOff = 1e-12; // of a limit
/** Distances [%] below it are no distance: a logarithmic axis shows them here. */
const nothing = 1e-6;
/** Violations that count, as in the table of iterations. */
const allowed = 1e-6;

export function convergenceSection(data: ReportData): HTMLElement | null {
  const text = data.files["history.csv"];
  if (!text) return null;
  const { header, rows } = parseCsv(text);
  const column = (name: string) => header.indexOf(name);
  const search = rows.filter((row) => row[column("request")] === "gradients" && row[column("purpose")] !== "audit" && row[column("objective")] !== "");
  if (search.length < 2) return null;
  const objective = data.result.objective;
  const unit = unitOf(data.picture, objective.name, objective.unit);
  const x = search.map((_, i) => i + 1);
  const numbers = (name: string) => search.map((row) => Number(row[column(name)]));
  const values = numbers("objective");
  const violation = numbers("max_violation");
  const distance = values.map((value) => 100 * Math.abs(value / objective.value - 1));
  const labels = search.map((row, i) => `iteration ${i + 1}, ${words(objective.name)} ${withUnit(values[i], unit, 6)}, ${seconds(Number(row[column("seconds")]))}`);
  const common = { xTitle: "iteration", wholeX: true, logY: true, height: 210 };
  return section(
    "How it converged",
    "Rings are designs that break a limit. Distances below 1e−6 % stand at 1e−6 %.",
    h(
      "div.columns",
      {},
      lineChart({
        ...common,
        title: `distance of ${words(objective.name)} to the answer`,
        yTitle: "% of it",
        series: [{ name: "distance", x, y: distance.map((one) => Math.max(one, nothing)), color: "accent", dots: true, hollow: violation.map((one) => one > allowed), labels }],
      }).element,
      violation.some((one) => one > roundOff)
        ? lineChart({
            ...common,
            title: "largest violation of a limit",
            yTitle: "% of the limit",
            series: [{ name: "violation", x, y: violation.map((one) => (one > roundOff ? 100 * one : null)), color: "limit", dots: true, labels }],
          }).element
        : h("p.note", {}, "No design on the way broke a limit."),
    ),
  );
}
