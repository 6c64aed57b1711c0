#include "cli/compare_report_style.hpp"

namespace sardf {

const char* const report_style = R"css(
:root {
  color-scheme: light dark;
  --page: #f6f7f9; --card: #ffffff; --ink: #1b2330; --quiet: #5f6b7a; --line: #dde2e9;
  --good: #14713d; --good-back: #e0f3e7; --bad: #b3261e; --bad-back: #fbe4e2; --accent: #2f6fdb;
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #12161c; --card: #1a2029; --ink: #e5eaf1; --quiet: #97a3b3; --line: #2d3643;
    --good: #6fd697; --good-back: #16351f; --bad: #ff8f86; --bad-back: #431b18; --accent: #82b1ff;
  }
}
* { box-sizing: border-box; }
body {
  margin: 0; background: var(--page); color: var(--ink);
  font: 16px/1.5 system-ui, "Segoe UI", "Noto Sans", "DejaVu Sans", sans-serif;
}
main { max-width: 1440px; margin: 0 auto; padding: 2rem clamp(1rem, 3vw, 3rem) 4rem; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0 0 .4rem; letter-spacing: -.015em; }
h2 { font-size: 1.35rem; line-height: 1.3; margin: 0; letter-spacing: -.01em; }
p { margin: .3rem 0; max-width: 75ch; }
a { color: var(--accent); }
.quiet { color: var(--quiet); }
.badge {
  display: inline-block; padding: .1em .7em; border-radius: 1em; font-weight: 600;
  font-size: .85rem; white-space: nowrap;
}
.good { color: var(--good); background: var(--good-back); }
.bad { color: var(--bad); background: var(--bad-back); }
section, .overview {
  background: var(--card); border: 1px solid var(--line); border-radius: 14px;
  padding: 1.4rem clamp(1rem, 2vw, 1.8rem); margin-top: 1.6rem;
}
.head { display: flex; flex-wrap: wrap; gap: .3rem 1rem; align-items: baseline; }
dl { display: flex; flex-wrap: wrap; gap: .2rem 1.6rem; margin: .5rem 0 0; font-size: .9rem; }
dl div { display: flex; gap: .5em; }
dt { color: var(--quiet); }
dd { margin: 0; font-variant-numeric: tabular-nums; }
.pictures {
  display: grid; gap: 1rem; margin-top: 1.2rem;
  grid-template-columns: repeat(var(--columns), minmax(0, 1fr));
}
figure { margin: 0; }
figcaption { font-size: .88rem; margin-bottom: .35rem; display: flex; gap: .6em; }
figcaption b { font-weight: 600; }
img { display: block; width: 100%; height: auto; border-radius: 8px; background: #000; }
.swap { position: relative; display: block; cursor: pointer; }
.swap input { position: absolute; opacity: 0; width: 1px; height: 1px; }
.swap .back {
  position: absolute; inset: 0; border-radius: 8px; background-size: 100% 100%; opacity: 0;
}
.swap:hover .back, .swap input:checked ~ .back { opacity: 1; }
.swap input:focus-visible ~ .back { outline: 3px solid var(--accent); outline-offset: 2px; }
.swap .tag {
  position: absolute; left: .6rem; bottom: .6rem; padding: .05em .6em; border-radius: .4em;
  font-size: .8rem; color: #fff; background: rgba(0, 0, 0, .62);
}
.swap .tag.reference, .swap:hover .tag.candidate, .swap input:checked ~ .tag.candidate {
  visibility: hidden;
}
.swap:hover .tag.reference, .swap input:checked ~ .tag.reference { visibility: visible; }
.swap:hover input:checked ~ .back { opacity: 0; }
.swap:hover input:checked ~ .tag.candidate { visibility: visible; }
.swap:hover input:checked ~ .tag.reference { visibility: hidden; }
.note { align-self: center; font-size: .9rem; }
.numbers { overflow-x: auto; margin-top: 1.4rem; }
table { border-collapse: collapse; width: 100%; font-size: .92rem; }
th, td { text-align: left; padding: .42rem .9rem .42rem 0; border-top: 1px solid var(--line); }
thead th { border-top: 0; color: var(--quiet); font-weight: 600; font-size: .85rem; }
tbody th { font-weight: 400; }
td { font-variant-numeric: tabular-nums; white-space: nowrap; }
td.fails { color: var(--bad); font-weight: 700; }
td.holds::before { content: "\2713\2002"; color: var(--good); }
td.fails::before { content: "\2717\2002"; }
tr.more th, tr.more td { color: var(--quiet); }
ul.failed { margin: .9rem 0 0; padding-left: 1.2rem; color: var(--bad); font-size: .92rem; }
@media (max-width: 720px) {
  .pictures { grid-template-columns: 1fr; }
}
@media print {
  section { break-inside: avoid; }
}
)css";

}  // namespace sardf
