import "./style.css";
import { BrokenPage, readPage } from "./payload";
import { showPage } from "./viewer";

const root = document.getElementById("app")!;
try {
  // For the console, and for tests.
  Object.assign(window, { gaussmapViewer: showPage(root, await readPage()) });
} catch (error) {
  const reason = error instanceof Error ? error.message : String(error);
  const notice = document.createElement("p");
  notice.className = "notice";
  notice.setAttribute("role", "alert");
  notice.textContent = error instanceof BrokenPage
    ? `This page cannot be shown: ${reason}. Make it again with gaussmap view FILE -o page.html.`
    : `This page cannot be shown: ${reason}`;
  root.replaceChildren(notice);
}
