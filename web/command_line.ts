// SPDX-License-Identifier: BSD-3-Clause
// What to type to get what is on the screen.
import {Incoming} from "./link";
import {commonCoating, Lens, Session, settingsBetween, sunlight_lx, uncoated, usualStray} from "./model";

function quoted(text: string): string {
  return /^[\w@%+=:,./-]+$/.test(text) ? text : `'${text.replace(/'/g, `'\\''`)}'`;
}

export function focusText(session: Session): string {
  return session.focus === "distance" ? `${session.focus_m}m` : session.focus;
}

/** As --coating takes them. */
function coatingText(lens: Lens): string {
  return commonCoating(lens) ?? lens.surfaces.map((each, i) => each.coating ? `surfaces[${i}]=${each.coating}` : "").filter(each => each).join(",");
}

/** `petzval image …` for the full picture, `petzval render …` where the scene has three dimensions. */
export function commandLine(session: Session, picture: Incoming | null, solid: boolean): string {
  const settings = settingsBetween(session.base, uncoated(session.lens)), coatings = coatingText(session.lens);
  const words = ["petzval", solid ? "render" : "image", session.scene, "--lens", settings === null ? "lens.json" : session.lensName];
  for (const setting of settings ?? []) words.push("--set", setting);
  if (coatings) words.push("--coating", coatings);
  if (session.f_number !== null) words.push("--f-number", String(session.f_number));
  if (session.blades !== null) words.push("--blades", String(session.blades));
  words.push("--focus", focusText(session));
  if (session.defocus_mm !== 0) words.push("--defocus", String(session.defocus_mm));
  // A spectral file stands where the lens expects it and fills the frame, whatever it says of that itself.
  const placed = !solid && picture?.scene_angle_deg;
  if (placed) words.push("--scene-angle", placed.toPrecision(8), "--scene-distance", picture.scene_distance_m === null ? "infinity" : `${picture.scene_distance_m}m`, "--scene-depth", "none");
  else if (session.distance_m !== null && !solid) words.push("--scene-distance", `${session.distance_m}m`);
  const light = session.illuminant || picture?.scene_illuminant;
  if (light && !solid) words.push("--illuminant", light);
  const columns = picture?.scene_columns as number | undefined;
  if (columns) words.push("--scene-size", `${columns}x${columns * 3 / 4}`);
  if (picture?.wavelengths) words.push("--wavelengths", picture.wavelengths);
  words.push("--sensor", session.sensor);
  for (const setting of picture?.sensor_settings ?? []) words.push("--sensor-set", setting);
  if (picture?.tolerance) words.push("--tolerance", String(picture.tolerance));
  if (picture?.samples) words.push("--spp", String(picture.samples));
  const stray = session.stray;
  for (const sun of stray.suns) words.push("--sun", sun.deg.join(",") + (sun.lx === sunlight_lx ? "" : `:${sun.lx}`));
  if (stray.ghosts) words.push("--ghosts");
  if (stray.ghosts && picture?.neglected_ghosts) words.push("--ghost-neglect", String(picture.neglected_ghosts));
  if (stray.starburst) words.push("--starburst");
  if (!solid && stray.threshold !== usualStray.threshold && (stray.ghosts || stray.starburst || stray.roughness_nm > 0)) words.push("--ghost-threshold", String(stray.threshold));
  if (stray.roughness_nm > 0) words.push("--scatter", `roughness=${stray.roughness_nm}`);
  const shot = session.shot;
  if (shot.compensation_ev !== 0) words.push("--exposure-compensation", String(shot.compensation_ev));
  if (!shot.noise) for (const source of ["shot", "dark", "read", "dsnu", "prnu", "column", "row", "defects"]) words.push("--without", source);
  if (shot.denoise !== 0) words.push("--denoise", String(shot.denoise));
  if (shot.sharpen !== 0) words.push("--sharpen", String(shot.sharpen));
  if (shot.tone !== "none") words.push("--tone", shot.tone);
  words.push("-o", "picture.png");
  return words.map(quoted).join(" ");
}
