"use strict";
// Dark or light.

const theme = document.getElementById("theme");
const prefersDark = window.matchMedia("(prefers-color-scheme: dark)");
const isDark = () => (document.documentElement.dataset.theme || (prefersDark.matches ? "dark" : "light")) === "dark";

function themed() {
  theme.textContent = isDark() ? "light" : "dark";
  theme.setAttribute("aria-label", `colours: ${theme.textContent}`);
  styles.clear();
  redraws.forEach((redraw) => redraw());
}

theme.hidden = false;
theme.addEventListener("click", () => {
  document.documentElement.dataset.theme = isDark() ? "light" : "dark";
  themed();
});
prefersDark.addEventListener("change", themed);
theme.textContent = isDark() ? "light" : "dark";
