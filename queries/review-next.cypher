// name: review-next
// kind: table
// description: Which open nodes should a person review next, as data gets to them before any other open node?
// param robot: robot, only this robot; all of them if it is empty, default ""
// returns distance: integer, flows from the nearest source
// returns findings: integer, how many findings have it on their shortest path, without dismissed ones
// returns kind: string, kind of the element
// returns element: string, name of the element
// returns categories: list of string, kinds of data that no label covers there
// returns robots: integer, on how many robots
// returns some_robots: list of string, the first five of them
// order: distance, findings DESC, kind, element
MATCH (e:Element {frontier: true})
WHERE $robot = '' OR e.robot = $robot
WITH e ORDER BY e.robot
WITH e.kind AS kind, e.name AS element, min(e.distance) AS distance, collect(DISTINCT e.robot) AS names,
     collect(e) AS here
CALL (here) {
  UNWIND here AS e
  UNWIND e.open AS category
  WITH DISTINCT category ORDER BY category
  RETURN collect(category) AS categories
}
CALL (here) {
  UNWIND here AS e
  MATCH (e)<-[:ACROSS]-(f:Finding {dismissed: false})
  RETURN count(DISTINCT f) AS findings
}
RETURN distance, findings, kind, element, categories, size(names) AS robots, names[..5] AS some_robots
ORDER BY distance, findings DESC, kind, element
