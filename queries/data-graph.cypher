// name: data-graph
// kind: path
// description: Where does personal data go, step by step, from where it begins to wherever it gets?
// param category: category, only this category, narrower ones and what may be of it; all of them if it is empty, default ""
// param robot: robot, only what begins or ends at this robot; all robots if it is empty, default ""
// returns robot: string, name of the robot where the step begins
// returns category: string, the kind of data that goes the step
// returns from: string, id of the element where the step begins
// returns to: string, id of the element where it ends
// returns path: graph path, the step
// returns to_robot: string, name of the robot where the step ends, which may be another one
// returns may_be: boolean, whether the data only may be of the category asked for: its own is broader, or overlaps with it
// order: robot, category, from, to
CALL db.relationshipTypes() YIELD relationshipType AS type
WITH type WHERE type STARTS WITH 'CARRIES_'
MATCH (c:DataCategory)
WHERE 'CARRIES' + toUpper(replace(c.label, '_', '')) = replace(type, '_', '')
  AND ($category = '' OR EXISTS { (c)<-[:BROADER*0..]-()-[:BROADER*0..]->(:DataCategory {name: $category}) })
WITH type, c, $category <> '' AND NOT EXISTS { (c)-[:BROADER*0..]->(:DataCategory {name: $category}) } AS may_be
MATCH path = (a:Element)-[r WHERE type(r) = type]->(b:Element)
WHERE $robot = '' OR a.robot = $robot OR b.robot = $robot
RETURN a.robot AS robot, c.name AS category, a.id AS from, b.id AS to, path, b.robot AS to_robot, may_be
ORDER BY robot, category, from, to
