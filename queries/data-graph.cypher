// name: data-graph
// kind: path
// description: Where does personal data go, step by step, from where it begins to wherever it gets?
// param category: category, only this category and narrower ones; all of them if it is empty, default ""
// param robot: robot, only this robot; all of them if it is empty, default ""
// returns robot: string, name of the robot where the step begins
// returns category: string, the kind of data that goes the step
// returns from: string, id of the element where the step begins
// returns to: string, id of the element where it ends
// returns path: graph path, the step
// order: robot, category, from, to
CALL db.relationshipTypes() YIELD relationshipType AS type
WITH type WHERE type STARTS WITH 'CARRIES_'
MATCH (c:DataCategory)
WHERE 'CARRIES' + toUpper(replace(c.label, '_', '')) = replace(type, '_', '')
      AND ($category = '' OR EXISTS { (c)-[:BROADER*0..]->(:DataCategory {name: $category}) })
MATCH path = (a:Element)-[r WHERE type(r) = type]->(b:Element)
WHERE $robot = '' OR a.robot = $robot
RETURN a.robot AS robot, c.name AS category, a.id AS from, b.id AS to, path
ORDER BY robot, category, from, to
