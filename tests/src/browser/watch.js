// Stands before everything else in a page under test: remembers what goes wrong, and keeps the page from being taken for
// loaded before the probe at its end is done. Chromium prints a page once it is loaded, and an open frame keeps it loading.
window.probe = { problems: [] };
{
  const { problems } = window.probe;
  addEventListener("error", (event) => {
    problems.push(`error: ${event.message ?? `<${event.target.localName}> could not load`}`);
  }, true);
  addEventListener("unhandledrejection", (event) => problems.push(`unhandled rejection: ${event.reason}`));
  addEventListener("securitypolicyviolation", (event) => {
    problems.push(`against the content policy: ${event.violatedDirective} ${event.blockedURI.slice(0, 80)}`);
  });
  for (const level of ["error", "warn"]) {
    const ordinary = console[level];
    console[level] = (...said) => {
      problems.push(`console.${level}: ${said.join(" ")}`);
      ordinary.apply(console, said);
    };
  }
  const open = document.createElement("iframe");
  open.hidden = true;
  document.documentElement.append(open);
  open.contentDocument.open();
  window.probe.release = () => {
    open.contentDocument.close();
    open.remove();
  };
}
