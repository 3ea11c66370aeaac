// Reports within the page, one section at a time.

/** Style of a report within the page: it has no head, and shows the chosen section alone. */
const WITHIN = `<style>.bar, .skip, footer, #head h1, main > section:not(#head, .shown), section > h2 { display: none; }
main { max-width: none; padding: 0; } body { overflow: hidden; } .verdict { margin-top: 0.6rem; }</style>`;

export class ReportFrame {
  constructor(place, title) {
    Object.assign(this, { place, title, frame: null, section: null });
    this.sections = element("div", { class: "sections", role: "group", "aria-label": `sections of the ${title}` });
    document.getElementById("theme").addEventListener("click", () => this.#themed());
  }

  /** Fades the report if the case has changed. */
  set old(old) { this.place.classList.toggle("old", old); }

  /** Shows a report, and calls `shown` when it is drawn. The report before it stays until then. */
  show(text, shown) {
    this.place.querySelectorAll(".coming").forEach((frame) => frame.remove());
    const { theme } = document.documentElement.dataset;
    const own = text.replace("<html lang=\"en\">", `<html lang="en"${theme ? ` data-theme="${theme}"` : ""}>`).replace("</head>", `${WITHIN}</head>`);
    const frame = element("iframe", { title: this.title, class: "coming", srcdoc: own });
    frame.addEventListener("load", () => {
      const root = frame.contentDocument.documentElement;
      const look = () => {
        if (!root.dataset.ready || !frame.isConnected) return;
        watch.disconnect();
        this.#swap(frame);
        shown();
      };
      const watch = new MutationObserver(look);
      watch.observe(root, { attributes: true });
      look();
    });
    this.place.append(frame);
  }

  /** Offers a button for each section. The section that was chosen before opens again. */
  #offer() {
    const links = [...this.frame.contentDocument.querySelectorAll(".bar nav a")].map((link) => [link.hash.slice(1), link.textContent]);
    const [first] = links.find(([id]) => id === this.section) || links[0];
    const buttons = links.map(([id, title]) => element("button", { type: "button", "data-section": id, onclick: () => { this.section = id; choose(id); } }, title));
    const choose = (id) => {
      buttons.forEach((button) => button.setAttribute("aria-pressed", String(button.dataset.section === id)));
      links.forEach(([each]) => this.frame.contentDocument.getElementById(each).classList.toggle("shown", each === id));
    };
    this.sections.replaceChildren(...buttons);
    choose(first);
  }

  #swap(frame) {
    if (this.frame) this.frame.remove();
    this.frame = frame;
    frame.classList.remove("coming");
    const { body } = frame.contentDocument;
    this.place.prepend(this.sections);
    this.#offer();
    const fit = () => { frame.style.height = `${Math.ceil(body.getBoundingClientRect().height) + 8}px`; };
    new ResizeObserver(fit).observe(body);
    fit();
  }

  #themed() {
    if (!this.frame) return;
    const { contentDocument, contentWindow } = this.frame;
    contentDocument.documentElement.dataset.theme = document.documentElement.dataset.theme;
    contentWindow.themed();
  }
}
