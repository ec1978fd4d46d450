// Numbered marks at the places of the drawing where limits bite; a click leads to the instant.
import { Vector3 } from "three";
import type { Picture } from "../data";
import { h } from "../dom";
import { seconds } from "../format";
import type { Player } from "./player";
import { pointAlong } from "./pose";

export interface Mark {
  number: number;
  name: string; // of the limit, in words
  text: string; // its value and the limit
  time?: number;
  body?: number;
  share?: number; // along the body
  joint?: number;
  onClick(): void;
}

const fewMarks = 4;

export function addMarks(player: Player, picture: Picture, marks: Mark[]): void {
  const stage = player.stage;
  if (!stage) return;
  const end = picture.scene.end_time;
  for (const mark of marks) {
    const at = (): Vector3 | null => {
      const { motion, poses } = stage.mainPoses();
      if (!poses) return null;
      if (mark.joint !== undefined) return motion.place(motion.design.geometry.joints[mark.joint].places[1], poses);
      if (mark.body === undefined) return null;
      const pose = poses[mark.body];
      if (mark.share !== undefined) return pointAlong(pose, mark.share);
      return pose.points[Math.floor(pose.points.length / 2)].clone();
    };
    const when = mark.time === undefined ? "" : ` · ${seconds(mark.time)}`;
    const element = h(
      "button.mark",
      { "aria-label": `${mark.name}: ${mark.text}${when}`, title: `${mark.name}: ${mark.text}${when}`, onclick: mark.onClick },
      h("b", {}, String(mark.number)),
      h("span", {}, `${mark.name}${when}`),
    );
    element.classList.toggle("is-short", marks.length > fewMarks);
    stage.addLabel(element, at, true);
    player.onTime((time) => element.classList.toggle("is-now", mark.time !== undefined && Math.abs(time - mark.time) < 4e-3 * end));
  }
}
