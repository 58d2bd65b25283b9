// How a player looks; a page changes it by the custom properties and by `::part`.
export const STYLE = `
:host {
  display: block; position: relative; box-sizing: border-box; aspect-ratio: 4 / 5;
  min-width: 8rem; overflow: hidden; background: #d1dbe3; color: #111; border-radius: 6px;
  font: 14px/1.4 system-ui, sans-serif;
}
:host([hidden]) { display: none; }
canvas { position: absolute; inset: 0; width: 100%; height: 100%; display: block; }
canvas:focus-visible { outline: 3px solid #1a5fb4; outline-offset: -3px; }
:host([data-loading]) canvas { opacity: .4; }
.bar {
  position: absolute; inset: auto 0 0 0; display: flex; align-items: center; gap: .5rem;
  padding: .4rem .6rem; background: rgb(255 255 255 / .82); container-type: inline-size;
}
.bar button, .bar select { font: inherit; min-height: 2rem; min-width: 2rem; color: inherit; }
.bar input[type=range] { flex: 1; min-width: 3rem; }
.bar output { min-width: 4em; text-align: right; font-variant-numeric: tabular-nums; }
.bar label { display: flex; align-items: center; gap: .15rem; min-height: 2rem; }
@container (max-width: 24rem) { .bar output { display: none; } }
@container (max-width: 16rem) { .bar label { display: none; } }
[role=alert] {
  position: absolute; inset: auto 1rem 4rem 1rem; margin: 0; padding: .6rem .8rem;
  background: #fff; border-left: 4px solid #a51d2d;
}
`;
