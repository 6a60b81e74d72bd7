// name: carrying-both
// kind: table
// description: Which elements do two kinds of data both get to, such as voice and location?
// param first: category, a category's name; narrower ones count too
// param second: category, another one
// param robot: robot, only this robot; all of them if it is empty, default ""
// returns robot: string, name of the robot
// returns kind: string, kind of the element
// returns element: string, name of the element
// returns leaks: list of string, which of the two, or of narrower ones, it lets out
// order: robot, kind, element
OPTIONAL MATCH (c:DataCategory)<-[:BROADER*0..]-(k:DataCategory) WHERE c.name IN [$first, $second]
WITH collect(DISTINCT k.name) AS asked
MATCH (e:Element)
WHERE $first IN e.carries AND $second IN e.carries AND ($robot = '' OR e.robot = $robot)
RETURN DISTINCT e.robot AS robot, e.kind + coalesce(' ' + e.leg, '') AS kind, e.name AS element,
       [k IN e.leaks WHERE k IN asked] AS leaks
ORDER BY robot, kind, element
