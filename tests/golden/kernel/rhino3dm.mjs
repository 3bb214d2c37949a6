// node rhino3dm.mjs FOLDER < questions > rhino3dm.json, where FOLDER holds the unpacked npm package
// rhino3dm and the questions are what print_witness_questions printed.

import {readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {resolve} from 'node:path';

const folder = resolve(process.argv[2]);
const require = createRequire(import.meta.url);
const {version} = require(`${folder}/package.json`);
const rhino = await require(`${folder}/rhino3dm.js`)();

// openNURBS has neither the first nor the last of the knots.
function setKnots(list, knots) {
  if (list.count !== knots.length - 2) throw new Error(`${list.count} knots`);
  knots.slice(1, -1).forEach((knot, i) => list.set(i, knot));
}

function surfaceOf({degree, count, knots, points, weights}) {
  const rational = weights.length > 0;
  const surface =
      rhino.NurbsSurface.create(3, rational, degree[0] + 1, degree[1] + 1, count[0], count[1]);
  setKnots(surface.knotsU(), knots[0]);
  setKnots(surface.knotsV(), knots[1]);
  const list = surface.points();
  for (let j = 0; j < count[1]; ++j) {
    for (let i = 0; i < count[0]; ++i) {
      const at = i + count[0] * j;
      const weight = rational ? weights[at] : 1;
      const point = points.slice(3 * at, 3 * at + 3).map(x => x * weight);  // homogeneous
      list.set(i, j, [...point, weight]);
    }
  }
  if (!surface.isValid) throw new Error('openNURBS refuses a surface');
  return surface;
}

// The curve of constant v runs along u.
function answerAt(surface, [u, v]) {
  return {
    at: [u, v],
    point: surface.pointAt(u, v),
    normal: surface.normalAt(u, v),
    u_derivatives: surface.isoCurve(0, v).derivativeAt(u, 3).slice(1),
    v_derivatives: surface.isoCurve(1, u).derivativeAt(v, 3).slice(1),
  };
}

const {surfaces} = JSON.parse(readFileSync(0, 'utf8'));
const lines = surfaces.map(question => {
  const surface = surfaceOf(question);
  const places = question.places.map(({at}) => answerAt(surface, at));
  return JSON.stringify({...question, places});
});
process.stdout.write(`{"made_by":"rhino3dm ${version}","surfaces":[\n${lines.join(',\n')}\n]}\n`);
