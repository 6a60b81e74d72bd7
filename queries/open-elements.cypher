// name: open-elements
// kind: table
// description: Which elements does personal data get to that no label covers, those on the most leak paths first?
// param robot: robot, only this robot; all of them if it is empty, default ""
// returns findings: integer, how many findings have it on their shortest path, without dismissed ones
// returns frontier: boolean, whether data gets to it before any other open node
// returns distance: integer, flows from the nearest source
// returns robot: string, name of the robot
// returns kind: string, kind of the element
// returns element: string, name of the element
// returns categories: list of string, kinds of data that no label covers there
// order: findings DESC, frontier DESC, distance, robot, kind, element
MATCH (e:Element)
WHERE size(e.open) > 0 AND ($robot = '' OR e.robot = $robot)
WITH e.robot AS robot, e.kind + coalesce(' ' + e.leg, '') AS kind, e.name AS element,
     collect(e) AS sides  // a wildcard has one to write and one to read
WITH robot, kind, element, sides[0] AS e,
     COUNT { UNWIND sides AS side MATCH (side)<-[:ACROSS]-(f:Finding {dismissed: false}) RETURN DISTINCT f } AS findings
RETURN findings, e.frontier AS frontier, e.distance AS distance, robot, kind, element, e.open AS categories
ORDER BY findings DESC, frontier DESC, distance, robot, kind, element
