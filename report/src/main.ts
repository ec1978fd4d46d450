import "./style.css";
import { readData, type ReportData } from "./data";
import { h, heroOf, type Page } from "./dom";
import { accuracyPage } from "./pages/accuracy";
import { checkPage } from "./pages/check";
import { comparePage } from "./pages/compare";
import { gradientPage } from "./pages/gradient";
import { filesSection } from "./pages/parts";
import { optimizePage } from "./pages/optimize";
import { pricesPage } from "./pages/prices";
import { showPage, simulatePage } from "./pages/simulate";
import { stabilityPage } from "./pages/stability";
import { hero, paretoPage } from "./pages/studies";
import { uncertaintyPage } from "./pages/uncertainty";
import { paperChoice } from "./paper";
import { startTheme, themeButton } from "./theme";

function pageOf(data: ReportData): Page {
  switch (data.card.command) {
    case "optimize":
      return optimizePage(data);
    case "simulate":
      return simulatePage(data);
    case "show":
      return showPage(data);
    case "pareto":
      return paretoPage(data);
    case "accuracy":
      return accuracyPage(data);
    case "prices":
      return pricesPage(data);
    case "uncertainty":
      return uncertaintyPage(data);
    case "stability":
      return stabilityPage(data);
    case "gradient":
      return gradientPage(data);
    case "compare":
      return comparePage(data);
    case "check":
      return checkPage(data);
    default:
      return [hero(data, ""), filesSection(data)]; // of invariants, which are written for other programs
  }
}

/** A document that is not whole shows what can be read of it. */
function wholePage(data: ReportData): Page {
  try {
    return pageOf(data);
  } catch (error) {
    console.warn(error);
    const text = `The result of this run is not whole, or of another version: its page cannot be made (${String(error)}).`;
    return [heroOf([h("h1", {}, data.card.command ?? ""), h("p.verdict", {}, h("span.badge.warn", {}, "! damaged"), ` ${text}`)]), filesSection(data)];
  }
}

function start(): void {
  const page = document.getElementById("page")!;
  const data = readData();
  startTheme();
  if (!data) {
    page.append(h("p.note", {}, "This is the page without data: the program pleuel fills it in."));
    return;
  }
  const name = data.picture?.name ?? data.card.command;
  document.title = `${name} · ${data.card.command} · Pleuel`;
  page.append(
    h(
      "nav.top",
      { "aria-label": "report" },
      h("span.brand", {}, "Pleuel"),
      h("span.soft", {}, [data.card.command, data.card.input?.file].filter(Boolean).join(" · ")),
      h("span.spring", {}),
      paperChoice(),
      h("button.quiet", { onclick: () => window.print(), title: "print" }, "Print"),
      themeButton(),
    ),
    ...wholePage(data).filter((part) => part !== null),
    h("footer.soft", {}, `Pleuel ${data.card.versions?.pleuel ?? ""} · space plays, arrows go from instant to instant, Ctrl and wheel zoom`),
  );
}

start();
