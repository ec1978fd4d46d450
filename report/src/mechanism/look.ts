// How a body is drawn.
import type { LineBasicMaterial, LineSegments, Mesh, MeshLambertMaterial } from "three";

export interface Look {
  color: [number, number, number];
  edge: string;
  opacity: number;
  isGhost: boolean;
}

/** @param ghostLine opacity of the edges of a ghost */
export function showLook(mesh: Mesh, edges: LineSegments, look: Look, isSelected: boolean, ghostLine: number): void {
  const material = mesh.material as MeshLambertMaterial;
  material.opacity = look.opacity;
  material.depthWrite = !look.isGhost;
  mesh.renderOrder = look.isGhost ? 1 : 2;
  edges.renderOrder = look.isGhost ? 1 : 3;
  const line = edges.material as LineBasicMaterial;
  line.color.set(look.edge);
  line.opacity = look.isGhost ? ghostLine : isSelected ? 1 : 0.5;
}
