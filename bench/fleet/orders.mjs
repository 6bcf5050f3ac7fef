// Orders of the test.

/** Nodes at x, y \[m\] on the map "hall", the first `released` of them in the base; `first`: place of the first among all. */
export function order(orderId, orderUpdateId, first, positions, released = positions.length) {
  const nodes = positions.map(([x, y, more = {}], i) => ({
    nodeId: `n${first + i}`,
    sequenceId: 2 * (first + i),
    released: i < released,
    nodePosition: { x, y, mapId: "hall", ...more },
    actions: [],
  }));
  const edges = positions.slice(1).map((_, i) => ({
    edgeId: `e${first + i}`,
    sequenceId: 2 * (first + i) + 1,
    released: i + 1 < released,
    startNodeId: `n${first + i}`,
    endNodeId: `n${first + i + 1}`,
    actions: [],
  }));
  return { orderId, orderUpdateId, nodes, edges };
}

/** An instant action, or one at a node. */
export function action(actionId, actionType, parameters = {}, blockingType = "HARD") {
  const actionParameters = Object.entries(parameters).map(([key, value]) => ({ key, value }));
  return { actionId, actionType, blockingType, actionParameters };
}
