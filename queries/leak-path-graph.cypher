// name: leak-path-graph
// kind: path
// description: Which paths lead from where a kind of data begins, at a source or where it is made, to its leaks?
// param category: category, only this category, narrower ones and what may be of it; all of them if it is empty, default ""
// param robot: robot, only what begins or ends at this robot; all robots if it is empty, default ""
// returns robot: string, name of the robot where it begins
// returns category: string, the kind of data that arrives
// returns source: string, where it begins
// returns leak: string, where it gets out
// returns path: graph path, a shortest one that goes through no other leak of the category
// returns leak_robot: string, name of the robot of the leak, which may be another one
// returns may_be: boolean, whether the data only may be of the category asked for: its own is broader, or overlaps with it
// order: robot, category, source, leak, leak_robot
CALL db.relationshipTypes() YIELD relationshipType AS type
WITH type WHERE type STARTS WITH 'CARRIES_'
MATCH (c:DataCategory)
WHERE 'CARRIES' + toUpper(replace(c.label, '_', '')) = replace(type, '_', '')
  AND ($category = '' OR EXISTS { (c)<-[:BROADER*0..]-()-[:BROADER*0..]->(:DataCategory {name: $category}) })
WITH type, c.name AS category, c.label + 'Source' AS begins, c.label + 'Leak' AS leaks,
     $category <> '' AND NOT EXISTS { (c)-[:BROADER*0..]->(:DataCategory {name: $category}) } AS may_be
MATCH (start:Element)
WHERE begins IN labels(start)
CALL (type, leaks, start) {
  MATCH path = SHORTEST 1 (start)-[first WHERE type(first) = type]->()
               ((x WHERE NOT leaks IN labels(x))-[r WHERE type(r) = type]->()){0,}
               (leak:Element WHERE leaks IN labels(leak))
  RETURN path, leak.name AS leak, leak.robot AS leak_robot
}
WITH * WHERE $robot = '' OR start.robot = $robot OR leak_robot = $robot
WITH start.robot AS robot, category, start.name AS source, leak, leak_robot, may_be, path,
     [n IN nodes(path) | n.id] AS ids
ORDER BY length(path), ids
WITH robot, category, source, leak, leak_robot, may_be, collect(path)[0] AS path
RETURN robot, category, source, leak, path, leak_robot, may_be
ORDER BY robot, category, source, leak, leak_robot
