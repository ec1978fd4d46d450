// The drawing of a mechanism in motion beside what is known of the member that was clicked.
import type { Picture } from "../data";
import { h } from "../dom";
import { makePlayer, type Pick as Picked, type Player } from "../mechanism/player";
import { makeInspector } from "./inspector";

export interface Viewing {
  element: HTMLElement;
  player: Player;
  pickBody(name: string | undefined): void;
  /** Calls with the name of each body that is clicked. */
  onBody(listener: (body: string) => void): void;
}

/** The drawing beside what is known of the member that was clicked. */
export function viewing(picture: Picture, main: number, showsNames = false, showsAxes = false, unheld: string[] = []): Viewing {
  let player: Player | null = null;
  const listeners: ((body: string) => void)[] = [];
  const choose = (pick: Picked) => {
    player?.select(pick.body);
    inspector.show(pick);
    if (pick.body !== null) for (const listener of listeners) listener(picture.scene.bodies[pick.body].name);
  };
  const inspector = makeInspector(picture, main, (time) => player?.goTo(time), choose);
  player = makePlayer({
    picture,
    main,
    showsNames,
    showsAxes,
    unheld,
    onPick: choose,
  });
  player.onTime((time) => inspector.setTime(time));
  const made = player;
  Object.assign(window, { pleuelPlayer: made });  // for tests
  return {
    element: h("section.card.viewing", { "aria-label": "mechanism" }, made.element, inspector.element),
    player: made,
    onBody: (listener) => listeners.push(listener),
    pickBody(name) {
      const body = picture.scene.bodies.findIndex((one) => one.name === name);
      made.select(body < 0 ? null : body);
      inspector.show({ body: body < 0 ? null : body, joint: null });
    },
  };
}
