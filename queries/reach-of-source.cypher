// name: reach-of-source
// kind: path
// description: Where does the data of one source get to, and as which kind of data?
// param source: element, name of the source, such as /camera
// param robot: robot, only what begins or ends at this robot; all robots if it is empty, default ""
// returns robot: string, name of the source's robot
// returns category: string, the kind of data that gets there, from the source or made of its data on the way
// returns steps: integer, flows on the way there; 0 for the source itself
// returns kind: string, kind of the element
// returns element: string, name of the element
// returns path: list of string, names in the order of the flow, source first
// returns element_robot: string, name of the robot of the element, which may be another one
// order: robot, category, steps, kind, element, element_robot
MATCH (start:Element {name: $source})
CALL (start) {
  UNWIND start.begins AS category
  RETURN category, start AS origin, [start.name] AS way, false AS made
UNION
  MATCH (origin:Element)-[d:DERIVES_FROM]->(start)
  RETURN d.category AS category, origin, d.way AS way, true AS made
}
CALL (category, origin, way, made) {
  RETURN origin AS element, way AS path
UNION
  MATCH p = ANY SHORTEST (origin)-[first:FLOWS_TO
                                   WHERE category IN CASE WHEN made THEN first.made ELSE first.begins END]->()
            (()-[f:FLOWS_TO WHERE category IN f.passes]->()){0,}(element:Element)
  RETURN element, way + [r IN relationships(p)  // the two sides of a wildcard are shown as one
                         WHERE r.role IS NULL OR r.role <> 'matches' OR startNode(r).name <> endNode(r).name
                         | endNode(r).name] AS path
}
WITH start.robot AS robot, category, element.kind + coalesce(' ' + element.leg, '') AS kind, element.name AS element,
     element.robot AS element_robot, path ORDER BY size(path), path
WHERE $robot = '' OR robot = $robot OR element_robot = $robot
WITH robot, category, kind, element, element_robot, collect(path)[0] AS path
RETURN robot, category, size(path) - 1 AS steps, kind, element, path, element_robot
ORDER BY robot, category, steps, kind, element, element_robot
