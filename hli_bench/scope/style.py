"""Style sheet of the report: light and dark, phone and paper."""

from typing import Final

CSS: Final = """
:root { color-scheme: light dark; --ink: #1b1f24; --soft: #5c6670; --faint: #d9dee3; --paper: #fff; --panel: #f7f8fa;
  --position: #1f6feb; --lag: #b35900; --signal: #116b4f; --mark: #c2255c; --good: #116b4f; --bad: #b3261e; }
@media (prefers-color-scheme: dark) { :root { --ink: #e4e8ec; --soft: #98a2ad; --faint: #343b43; --paper: #14171b;
  --panel: #1b1f25; --position: #6ea8fe; --lag: #f0a04b; --signal: #4cc38a; --mark: #ff7eb6; --good: #4cc38a;
  --bad: #ff8a80; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 60rem; padding: 2rem 1.25rem 4rem; background: var(--paper); color: var(--ink);
  font: 1rem/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif; }
h1 { margin: 0; font-size: 1.6rem; line-height: 1.25; overflow-wrap: anywhere; }
h2 { margin: 2.5rem 0 .75rem; font-size: 1.15rem; }
h3 { margin: 1.75rem 0 .25rem; font-size: 1rem; }
p { margin: .25rem 0; } .soft { color: var(--soft); font-size: .875rem; }
.status { font-weight: 600; } .completed { color: var(--good); } .error, .aborted { color: var(--bad); }
.facts { display: flex; flex-wrap: wrap; gap: .25rem 2rem; margin: .75rem 0 0; padding: 0; list-style: none; }
.facts span { display: block; color: var(--soft); font-size: .8rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { padding: .3rem .9rem .3rem 0; text-align: left; vertical-align: top; border-bottom: 1px solid var(--faint); }
th { color: var(--soft); font-size: .8rem; font-weight: 500; white-space: nowrap; }
td.n, th.n { text-align: right; } td.t { white-space: nowrap; }
td.w { min-width: 12rem; overflow-wrap: anywhere; }
ul.texts { margin: 0; padding: 0; list-style: none; font-family: ui-monospace, Menlo, Consolas, monospace;
  font-size: .9rem; overflow-wrap: anywhere; }
ul.texts b { color: var(--soft); font-weight: 400; display: inline-block;
  min-width: 3.5rem; padding-right: .75rem; }
ul.bars { margin: .5rem 0 0; padding: 0; list-style: none; font-variant-numeric: tabular-nums; font-size: .8rem; }
.bars li { display: grid; grid-template-columns: 9rem 1fr 4.5rem; gap: .75rem; align-items: center; }
.bars li span:first-child, .bars li span:last-child { text-align: right; } .bar { background: var(--panel); }
.bars i { display: block; height: .7rem; background: var(--signal); print-color-adjust: exact; }
details { margin-top: 1rem; } summary { cursor: pointer; color: var(--soft); }
figure { margin: .5rem 0 0; break-inside: avoid; }
.name { margin: .6rem 0 .15rem 3.6rem; color: var(--soft); font-size: .8rem; line-height: 1.2; }
.bare .name { margin-left: 0; } .name b { color: var(--ink); font-weight: 600; }
.panel { display: grid; grid-template: 100% / 3.6rem 1fr; } .bare .panel { grid-template: 100% / 1fr; }
.y { position: relative; font-size: .72rem; color: var(--soft); font-variant-numeric: tabular-nums; }
.y span { position: absolute; right: .45rem; transform: translateY(-50%); }
.plot { position: relative; background: var(--panel); }
.plot svg { position: absolute; inset: 0; width: 100%; height: 100%; }
.x { position: relative; height: 1.4rem; margin-left: 3.6rem; font-size: .72rem; color: var(--soft);
  font-variant-numeric: tabular-nums; }
.bare .x { margin-left: 0; }
.x span { position: absolute; top: .2rem; transform: translateX(-50%); white-space: nowrap; }
.x span.first { transform: none; } .x span.last { transform: translateX(-100%); }
.unit { margin: 0; text-align: right; color: var(--soft); font-size: .72rem; }
svg * { vector-effect: non-scaling-stroke; }
.grid { stroke: var(--faint); stroke-width: 1; } .mark { stroke: var(--mark); stroke-width: 1; stroke-dasharray: 3 3; }
.level { stroke: var(--mark); stroke-width: 1; opacity: .6; }
.position { stroke: var(--position); fill: var(--position); } .lag { stroke: var(--lag); fill: var(--lag); }
.signal { stroke: var(--signal); fill: none; } .position, .lag, .signal { stroke-width: 1.5; stroke-linejoin: round; }
.high { fill: var(--signal); opacity: .14; stroke: none; } .tick { stroke: var(--soft); stroke-width: 1.25; }
.wrote { stroke: var(--mark); stroke-width: 2.5; }
.value { position: absolute; top: 50%; transform: translateY(-50%); padding-left: .3rem; font-size: .72rem;
  font-family: ui-monospace, Menlo, Consolas, monospace; }
@media (max-width: 32rem) { body { padding: 1.25rem .9rem 3rem; } .x span.odd { display: none; } }
@media print { :root { --ink: #000; --soft: #444; --faint: #ccc; --paper: #fff; --panel: #fff; --position: #0b4fb3;
  --lag: #8a4500; --signal: #0b5a40; --mark: #a3184b; --good: #0b5a40; --bad: #a01810; }
  body { max-width: none; padding: 0; font-size: 10pt; } h2, h3 { break-after: avoid; }
  section { break-inside: avoid; } }
"""
