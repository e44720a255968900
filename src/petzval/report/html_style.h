// SPDX-License-Identifier: BSD-3-Clause
// The style sheet of a report page: light, dark and on paper.
#pragma once

#include <string_view>

namespace petzval::html {

inline constexpr std::string_view page_style = R"css(
:root{--ground:#f6f7f9;--card:#fff;--ink:#1f2328;--soft:#59636e;--line:#dde1e6;--accent:#0060a0;--tint:#eef5fb}
@media screen and (prefers-color-scheme:dark){:root{--ground:#0d0f12;--card:#15181d;--ink:#e6e9ee;--soft:#9aa4b0;
--line:#2a2f37;--accent:#6db6f2;--tint:#182634}}
*{box-sizing:border-box}
html{color-scheme:light dark;scroll-behavior:smooth}
body{margin:0 auto;padding:2.5rem 1.25rem 4rem;max-width:74rem;background:var(--ground);color:var(--ink);
font:16px/1.55 system-ui,"Segoe UI","Helvetica Neue",Arial,"DejaVu Sans",sans-serif}
header h1{margin:0;font-size:2.1rem;line-height:1.15;letter-spacing:-.015em}
header p{margin:.4rem 0 0;color:var(--soft);font-size:1.1rem}
nav{margin:1.4rem 0;padding:0;display:flex;flex-wrap:wrap;gap:.4rem}
nav a{padding:.15rem .7rem;border:1px solid var(--line);border-radius:1rem;background:var(--card);font-size:.9rem;
text-decoration:none}
a{color:var(--accent)}
section{margin:1.4rem 0;padding:1.3rem 1.5rem 1.5rem;background:var(--card);border:1px solid var(--line);
border-radius:.7rem}
h2{margin:0 0 .7rem;font-size:1.3rem;line-height:1.25}
p{margin:.6rem 0;max-width:48rem}
code{padding:.08em .32em;border-radius:.25em;background:var(--tint);font:.88em ui-monospace,Menlo,Consolas,
"DejaVu Sans Mono",monospace}
figure{margin:1rem 0}
figcaption{margin-top:.5rem;color:var(--soft);font-size:.92rem;max-width:48rem}
svg,img{max-width:100%;height:auto;vertical-align:top}
img{border-radius:.2rem}
.pixelated{image-rendering:pixelated}
.row{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(22rem,100%),1fr));gap:1rem 1.6rem;align-items:start}
.row figure,.row p{margin:.4rem 0}
.scroll{overflow-x:auto;margin:.9rem 0}
table{border-collapse:collapse;font-size:.94rem;font-variant-numeric:tabular-nums}
th,td{padding:.32rem .9rem .32rem 0;border-bottom:1px solid var(--line);text-align:left;vertical-align:top}
th{font-weight:600}
th .unit,dd .unit{color:var(--soft);font-weight:400}
td.number,th.number{text-align:right;white-space:nowrap}
.comparison td:nth-child(3){font-weight:600;color:var(--accent)}
.comparison td:nth-child(4){color:var(--soft)}
dl{display:grid;grid-template-columns:max-content auto;gap:.2rem 1.2rem;margin:.6rem 0}
dt{color:var(--soft)}
dd{margin:0;font-variant-numeric:tabular-nums}
.wipe{position:relative;display:grid;max-width:max-content;--at:50%}
.wipe>img{grid-area:1/1;width:100%}
.wipe>img+img{clip-path:inset(0 0 0 var(--at))}
.wipe>input{position:absolute;inset:0;width:100%;height:100%;margin:0;opacity:0;cursor:ew-resize}
.wipe>i{position:absolute;top:0;bottom:0;left:var(--at);width:2px;margin-left:-1px;background:#fff;
box-shadow:0 0 4px #000;pointer-events:none}
.wipe>input:focus-visible+i{background:#e69f00}
.wipe>b{position:absolute;bottom:.5rem;padding:.1rem .55rem;border-radius:.9rem;background:#000a;color:#fff;
font-size:.8rem;font-weight:500;pointer-events:none}
.wipe>b:first-of-type{left:.5rem}
.wipe>b:last-of-type{right:.5rem}
.download{margin:.2rem 0 .8rem;font-size:.85rem}
footer{margin-top:2rem;color:var(--soft);font-size:.88rem}
pre{margin:.6rem 0;padding:.6rem .8rem;border-radius:.4rem;background:var(--tint);overflow-x:auto;
font:.82rem/1.5 ui-monospace,Menlo,Consolas,"DejaVu Sans Mono",monospace}
@media print{body{max-width:none;padding:0;background:#fff;font-size:11pt}nav,.download,.wipe>input,.wipe>i{display:none}
@page{margin:14mm}svg{max-height:21cm}.scroll{overflow:visible}table{font-size:7.5pt;width:auto}
th,td{padding:.15rem .45rem .15rem 0}td.number,th.number{white-space:normal}
section{border:0;padding:0;margin:0 0 1.2rem}h2{break-after:avoid}figure,table,.row>*{break-inside:avoid}
.wipe{grid-template-columns:1fr 1fr;gap:.5rem;max-width:none}.wipe>img{grid-area:auto}.wipe>img+img{clip-path:none}
.wipe>b:last-of-type{right:.5rem}
.sheet{font-size:8.5pt;line-height:1.3}.sheet h1{font-size:16pt}.sheet h2{font-size:10.5pt;margin-bottom:.2rem}
.sheet section{margin:0 0 .5rem}.sheet p,.sheet figure{margin:.15rem 0;max-width:none}.sheet figcaption{font-size:7.5pt;margin-top:.15rem}
.sheet .row{grid-template-columns:1fr 1fr;gap:.3rem 1rem}.sheet .row svg{height:4.2cm;width:auto}.sheet .row img{height:4.9cm;width:auto}
.sheet pre{font-size:6.3pt;white-space:pre-wrap;padding:.2rem .4rem}.sheet footer{margin-top:.4rem;font-size:7pt}}
)css";

}  // namespace petzval::html
