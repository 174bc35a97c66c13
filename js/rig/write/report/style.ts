/** The report's style sheet and its hash; the report's policy allows only the style sheet with this hash. */

const LIGHT =
  "--page:#f5f6f7;--card:#fff;--sunk:#eceef0;--line:#d8dcdf;--ink:#1a1e22;--soft:#565e66;--good:#1c7240;--wrong:#b3261e;--open:#8a5a00;--c1:#c7641a;--c2:#7a4fb0;--c3:#0b62b8;--c4:#1c7240";
const DARK =
  "--page:#14171a;--card:#1c2024;--sunk:#111315;--line:#33393f;--ink:#e8eaec;--soft:#a3abb3;--good:#74cf98;--wrong:#ff8f85;--open:#f0c05e;--c1:#f0a25e;--c2:#b79ae6;--c3:#6cb2f7;--c4:#74cf98";

export const STYLE = `
:root{color-scheme:light dark;${LIGHT}}
@media (prefers-color-scheme:dark){:root{${DARK}}}
*{box-sizing:border-box}
body{margin:0 auto;max-width:72rem;padding:1.5rem 1rem 3rem;font:15px/1.5 system-ui,sans-serif;color:var(--ink);background:var(--page);overflow-wrap:anywhere}
h1{font-size:1.5rem;line-height:1.25;margin:0 0 .25rem}
h2{font-size:1.125rem;margin:0 0 .5rem}
h3{font-size:1rem;margin:1rem 0 .5rem}
p{margin:.5rem 0;max-width:52rem}
section{background:var(--card);border:1px solid var(--line);border-radius:.5rem;padding:1rem;margin:1rem 0}
figure{margin:0}
.soft,footer,dt,.says,.pictures figcaption{color:var(--soft);font-size:.8125rem}
.card{display:flex;gap:1rem}
.card>div{flex:1;min-width:0}
.card{background:var(--card);border:2px solid;border-radius:.5rem;padding:1rem;align-items:center}
.verdict{font-size:1.5rem;font-weight:700;line-height:1.25;margin:0}.interval{font-weight:400;font-size:1.125rem}
.subject{margin:.25rem 0 0;color:var(--soft)}
.consistent{--said:var(--good)}.off{--said:var(--wrong)}.undecided{--said:var(--open)}
.verdict,.word{color:var(--said)}.card{border-color:var(--said)}
.sign{stroke:var(--said);flex:none;width:3.5rem;height:3.5rem;fill:none;stroke-width:3;stroke-linecap:round;stroke-linejoin:round}
.facts{display:flex;flex-wrap:wrap;gap:.5rem 2rem;margin:.75rem 0 0}
dd{margin:0;font-variant-numeric:tabular-nums}
.warnings{margin:0;padding-left:1.25rem}.warnings li{margin:.25rem 0}.warnings li::marker{content:"! ";color:var(--wrong);font-weight:700}
table{border-collapse:collapse;width:100%;font-variant-numeric:tabular-nums}
.number,.word{white-space:nowrap;overflow-wrap:normal}
th,td{text-align:left;vertical-align:top;padding:.375rem .75rem .375rem 0;border-top:1px solid var(--line)}
thead th{overflow-wrap:normal;border-top:0;color:var(--soft);font-size:.8125rem;font-weight:400}
tbody th{font-weight:600}
.shares th:first-child{width:40%}.shares td.number{width:4rem}.shares .bars{width:9rem}.shares th .soft{font-weight:400}
.overlay{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,20rem),1fr));gap:.75rem;margin-top:.5rem}
.overlay figcaption{color:var(--soft);font-size:.8125rem}.edge{fill:none;stroke:#ff3cbe;stroke-width:2;stroke-linecap:round}
.extrinsics{display:flex;flex-wrap:wrap;gap:0 1.5rem}.extrinsics>div{flex:1 1 auto;min-width:0;max-width:100%}.extrinsics p{contain:inline-size}.extrinsics h3{margin:0}.extrinsics pre{margin:.25rem 0 .5rem;font-size:.6875rem;padding:.5rem}
.inputs em{font-style:normal;color:var(--wrong)}.shell{white-space:pre-wrap}
summary{cursor:pointer;font-weight:600}
.unknowns td,.unknowns th{white-space:nowrap;overflow-wrap:normal}
.candidates th:first-child{min-width:7rem}.inputs th:first-child{min-width:12rem}
.matrix{font-size:.8125rem;white-space:nowrap;overflow-wrap:normal}.scroll{overflow-x:auto}
pre{overflow-x:auto;background:var(--sunk);border-radius:.25rem;padding:.75rem;margin:.75rem 0;font-size:.8125rem}
code{font-size:.75rem}
svg{display:block;width:100%;height:auto;font:11px system-ui,sans-serif}
.bar{height:.625rem;margin-top:.4rem}.track{fill:var(--sunk)}.fill{fill:var(--c3)}
.grid{stroke:var(--line);fill:none}.tick{fill:var(--soft)}
.panels{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,19rem),1fr));gap:1.25rem;margin-top:1rem}
.panel figcaption{font-weight:600}
.level{fill:none;stroke:var(--ink);stroke-dasharray:3 3;opacity:.6}
.series,.width{stroke:var(--its)}.series{fill:none;stroke-width:2;stroke-linejoin:round}
.s1{--its:var(--c1)}.s2{--its:var(--c2);stroke-dasharray:7 3}.s3{--its:var(--c3);stroke-dasharray:2 2}.s4{--its:var(--c4);stroke-dasharray:8 3 2 3}.s5{--its:var(--ink)}
.width{fill:none;stroke-width:1.5;stroke-dasharray:none}
.best{fill:var(--its)}
.says{list-style:none;margin:.25rem 0 0;padding:0}
.key{display:inline-block;width:1.5rem;height:.5rem;vertical-align:middle}
.pictures{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,24rem),1fr));gap:1rem}
.pictures img{display:block;width:100%;height:auto;border-radius:.25rem}
@media screen and (max-width:48rem){
.stacks thead{display:none}.stacks tr{display:block;border-top:1px solid var(--line);padding:.5rem 0}
.stacks th,.stacks td{display:block;border:0;padding:.125rem 0}
.stacks td::before{content:attr(data-column) ": ";color:var(--soft)}
.shares thead{display:none}.shares tr{display:grid;grid-template-columns:1fr auto;gap:0 1rem;border-top:1px solid var(--line);padding:.5rem 0}
.shares th,.shares td{border:0;padding:0}.shares th:first-child,.shares td,.shares td.number,.shares .bars{width:auto}.shares td:nth-child(n+3){grid-column:1/-1}
.shares td[data-column]::before{content:attr(data-column) " ";color:var(--soft)}
.card{flex-direction:column;align-items:flex-start;gap:.5rem}.extrinsics>div{flex-basis:100%}.extrinsics pre{font-size:clamp(.5625rem,2.45vw,.6875rem)}
}
@page{margin:8mm}
@media print{
:root{color-scheme:light;${LIGHT};--page:#fff}
body{max-width:none;padding:0;font-size:7.5pt;line-height:1.25;print-color-adjust:exact;-webkit-print-color-adjust:exact}
section{border:0;border-top:1px solid var(--line);border-radius:0;padding:.6mm 0 0;margin:.6mm 0 0}
h2{font-size:8.5pt;margin:0 0 .5mm}h3{font-size:7.5pt}p{margin:.3mm 0;max-width:none}
.soft,dt,.says,thead th,.pictures figcaption,.overlay figcaption,.inputs{font-size:6.5pt}
.card{padding:1mm 3mm;gap:3mm}.sign{width:8mm;height:8mm}.verdict{font-size:11pt}.interval{font-size:8.5pt}
.facts{gap:0 3mm;margin:.5mm 0 0}th,td{padding:.3mm 2mm .3mm 0}.warnings{padding-left:3mm}.warnings li{margin:0}
.clamp{display:-webkit-box;-webkit-box-orient:vertical;-webkit-line-clamp:2;overflow:hidden}.subject .clamp,.many .clamp,p.clamp,figcaption.clamp{-webkit-line-clamp:1}
figure,tr,.card,pre{break-inside:avoid}h2,h3{break-after:avoid}
.overlay{grid-template-columns:1fr 1fr;gap:3mm;margin:0}.overlay svg{max-height:40mm}.large svg{max-height:65mm}
.panels{grid-template-columns:repeat(3,1fr);gap:.75rem}
.scroll,pre{overflow:visible}pre{white-space:pre-wrap;padding:.5mm 1mm}.matrix{font-size:7pt}.extrinsics{display:grid;grid-template-columns:minmax(0,3fr) minmax(0,2fr)}.extrinsics pre{font-size:5.5pt;margin:.3mm 0;padding:.3mm 0}.extrinsics h3{margin:0}pre.shell{font-size:6pt;margin:.5mm 0;max-height:20mm;overflow:hidden}
.inputs code{font-size:5.5pt;white-space:nowrap}
section:has(.apart){break-before:page}details:not([open]),footer{display:none}
}
`;

/** Hash of STYLE, base64; a test checks it and prints the correct one. */
export const STYLE_SHA256 = "WDIK/F7BcacxwOEtZIEIxg5AWsrLArgrxtLrMnVvXQw=";
